// Disparity rows become a image in colors. Nothing that a message says of itself is believed unless it agrees with
// the rest of it.
package stereod.spy;

import java.awt.image.BufferedImage;
import stereod.disparity_rows_t;

class RowsPicture {
    private static final int LARGEST_SIDE = 4096;
    private static final int UNMATCHED = 0x222224;  // also what was filled in: only what was measured is shown
    private static final int[][] STOPS = {{27, 20, 84}, {98, 40, 140}, {186, 66, 120}, {240, 130, 90}, {252, 240, 170}};

    private BufferedImage picture;
    private long frame = -1;
    private int rowsOfFrame;
    long frames, rowsLost, ignored;

    /** True if a message can be what stereod sends. */
    static boolean isSane(disparity_rows_t m) {
        return m.width > 0 && m.width <= LARGEST_SIDE && m.height > 0 && m.height <= LARGEST_SIDE && m.first_row >= 0
            && m.row_count > 0 && m.row_count <= m.height - m.first_row && m.disparities > 0 && m.scale > 0
            && (m.bytes_per_value == 1 || m.bytes_per_value == 2)
            && m.data.length == m.width * m.row_count * m.bytes_per_value
            && isSaneAxis(m.left, m.decimation_x, m.width) && isSaneAxis(m.top, m.decimation_y, m.height)
            && (m.filled.length == 0 || m.filled.length == (m.width + 7) / 8 * m.row_count);
    }

    private static boolean isSaneAxis(int first, int step, int count) {
        return first >= 0 && first < LARGEST_SIDE && step > 0 && step <= LARGEST_SIDE && first + (count - 1) * step < LARGEST_SIDE;
    }

    private static boolean isFilled(disparity_rows_t m, int x, int row) {
        return m.filled.length > 0 && (m.filled[row * ((m.width + 7) / 8) + x / 8] >> x % 8 & 1) != 0;
    }

    /** Draws the rows; the picture of the frame before, once a new one begins; else null. */
    BufferedImage take(disparity_rows_t m) {
        if (!isSane(m)) {
            ignored++;
            return null;
        }
        BufferedImage finished = null;
        boolean fits = picture != null && picture.getWidth() == m.width && picture.getHeight() == m.height;
        if (m.frame != frame || !fits) {
            if (fits && frame >= 0) {
                finished = picture;
                frames++;
                if (m.frame > frame && m.frame - frame < 1000) {
                    rowsLost += m.height - rowsOfFrame + (m.frame - frame - 1) * m.height;
                }
            }
            picture = new BufferedImage(m.width, m.height, BufferedImage.TYPE_INT_RGB);
            frame = m.frame;
            rowsOfFrame = 0;
        }
        rowsOfFrame += m.row_count;
        draw(m);
        return finished;
    }

    private void draw(disparity_rows_t m) {
        double range = Math.max(m.disparities / (double) m.scale - 1, 1), least = m.min_disparity / (double) m.scale;
        for (int i = 0; i < m.width * m.row_count; i++) {
            int value = m.bytes_per_value == 1 ? m.data[i] & 0xFF : m.data[2 * i] & 0xFF | (m.data[2 * i + 1] & 0xFF) << 8;
            boolean measured = value != m.invalid && !isFilled(m, i % m.width, i / m.width);
            int color = measured ? colorOf((value - least) / range) : UNMATCHED;
            picture.setRGB(i % m.width, m.first_row + i / m.width, color);
        }
    }

    /** From 0, far, to 1, near. */
    static int colorOf(double nearness) {
        double at = Math.max(0, Math.min(nearness, 1)) * (STOPS.length - 1);
        int k = Math.min((int) at, STOPS.length - 2);
        int color = 0;
        for (int j = 0; j < 3; j++) {
            color = color << 8 | (int) Math.round(STOPS[k][j] + (at - k) * (STOPS[k + 1][j] - STOPS[k][j]));
        }
        return color;
    }
}
