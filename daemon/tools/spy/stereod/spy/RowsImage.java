// SPDX-License-Identifier: BSD-3-Clause
// Makes an image in colors of disparity rows. Checks every field of a message before using it.
package stereod.spy;

import java.awt.image.BufferedImage;
import stereod.disparity_rows_t;

class RowsImage {
    private static final int MAX_SIDE = 4096;
    private static final int RAW = 0;  // encoding of disparity_rows_t

    private BufferedImage image;
    private long frame = -1;
    private int rowsOfFrame;
    long frames, rowsLost, ignored;
    /** Why messages cannot be shown; null if they can. */
    String problem;

    /** Returns whether stereod can have sent the message. */
    static boolean isValid(disparity_rows_t m) {
        return m.width > 0 && m.width <= MAX_SIDE && m.height > 0 && m.height <= MAX_SIDE && m.first_row >= 0
            && m.row_count > 0 && m.row_count <= m.height - m.first_row && m.disparities > 0 && m.scale > 0
            && (m.bytes_per_value == 1 || m.bytes_per_value == 2)
            && (m.encoding != RAW || m.data.length == m.width * m.row_count * m.bytes_per_value)
            && isAxis(m.left, m.decimation_x, m.width) && isAxis(m.top, m.decimation_y, m.height)
            && (m.filled.length == 0 || m.filled.length == (m.width + 7) / 8 * m.row_count)
            && (m.confidence.length == 0 || m.confidence.length == m.width * m.row_count);
    }

    private static boolean isAxis(int first, int step, int count) {
        return first >= 0 && first < MAX_SIDE && step > 0 && step <= MAX_SIDE && first + (count - 1) * step < MAX_SIDE;
    }

    private static boolean isFilled(disparity_rows_t m, int x, int row) {
        return m.filled.length > 0 && (m.filled[row * ((m.width + 7) / 8) + x / 8] >> x % 8 & 1) != 0;
    }

    /** Draws the rows. Returns the image of the previous frame when a new frame begins, else null. */
    BufferedImage take(disparity_rows_t m) {
        if (!isValid(m) || m.encoding != RAW) {
            ignored++;
            if (m.encoding != RAW) problem = "encoding " + m.encoding + " is not supported, only 0 (raw)";
            return null;
        }
        problem = null;
        BufferedImage finished = null;
        boolean fits = image != null && image.getWidth() == m.width && image.getHeight() == m.height;
        if (m.frame != frame || !fits) {
            if (fits && frame >= 0) {
                finished = image;
                frames++;
                if (m.frame > frame && m.frame - frame < 1000) {
                    rowsLost += m.height - rowsOfFrame + (m.frame - frame - 1) * m.height;
                }
            }
            image = new BufferedImage(m.width, m.height, BufferedImage.TYPE_INT_RGB);
            frame = m.frame;
            rowsOfFrame = 0;
        }
        rowsOfFrame += m.row_count;
        draw(m);
        return finished;
    }

    /** Draws measured disparities; filled ones look unmatched. */
    private void draw(disparity_rows_t m) {
        double range = Math.max(m.disparities / (double) m.scale - 1, 1), minimum = m.min_disparity / (double) m.scale;
        for (int i = 0; i < m.width * m.row_count; i++) {
            int value = m.bytes_per_value == 1 ? m.data[i] & 0xFF : m.data[2 * i] & 0xFF | (m.data[2 * i + 1] & 0xFF) << 8;
            boolean measured = value != m.invalid && !isFilled(m, i % m.width, i / m.width);
            int color = measured ? ColorMap.colorOf((value - minimum) / range) : ColorMap.UNMATCHED;
            image.setRGB(i % m.width, m.first_row + i / m.width, color);
        }
    }
}
