// SPDX-License-Identifier: BSD-3-Clause
// A window on one channel: an image for disparity rows and images, fields and charts for other messages.
package stereod.spy;

import java.awt.image.BufferedImage;
import java.io.ByteArrayInputStream;
import java.io.IOException;
import java.util.List;
import java.util.Locale;
import javax.imageio.ImageIO;
import javax.swing.JFrame;
import javax.swing.JScrollPane;
import javax.swing.SwingUtilities;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChartData;
import lcm.spy.ObjectPanel;
import stereod.camera_info_t;
import stereod.depth_rows_t;
import stereod.disparity_rows_t;
import stereod.frame_t;
import stereod.image_t;
import stereod.planar_lidar_t;
import stereod.pointcloud_t;
import stereod.status_t;

class ChannelWindow implements LCMSubscriber {
    private static final int GRAY = 1497715271, MJPEG = 1196444237;
    private static final int MAX_SIDE = 4096;
    private static final List<String> FIELDS = List.of("_STATUS", "_FRAME", "_SCAN", "_CAMERA_INFO", "_DEPTH", "_CLOUD");

    private final String channel, pattern;
    private final JFrame window;
    private final ImagePanel panel = new ImagePanel();
    private ObjectPanel fields;
    private final RowsImage rows = new RowsImage();
    private long begin = System.nanoTime(), next = begin, shown, total;

    ChannelWindow(String channel, int x, int y) {
        this.channel = channel;
        pattern = channel.replaceAll("[^A-Za-z0-9_]", "\\\\$0");
        window = new JFrame(channel);
        window.setDefaultCloseOperation(JFrame.DISPOSE_ON_CLOSE);
        if (hasFields()) {
            fields = new ObjectPanel(channel, new ChartData(System.currentTimeMillis() * 1000));
            JScrollPane scroll = new JScrollPane(fields);
            fields.setViewport(scroll.getViewport());
            window.add(scroll);
            window.setSize(660, 700);
        } else {
            window.add(panel);
            window.pack();
        }
        window.setLocation(x, y);
        window.setVisible(true);
        LCM.getSingleton().subscribe(pattern, this);
    }

    @Override
    public void messageReceived(LCM lcm, String name, LCMDataInputStream in) {
        if (!window.isDisplayable()) {
            lcm.unsubscribe(pattern, this);
            return;
        }
        try {
            if (fields != null) {
                show(messageOf(in));
            } else if (channel.endsWith("_DISPARITY")) {
                show(rows.take(new disparity_rows_t(in)));
                if (rows.problem != null) showProblem(rows.problem);
            } else {
                BufferedImage image = imageOf(new image_t(in));
                if (image == null) rows.ignored++;
                show(image);
            }
        } catch (IOException | RuntimeException | OutOfMemoryError error) {  // not a message of stereod
            rows.ignored++;
        }
    }

    private boolean hasFields() {
        return FIELDS.stream().anyMatch(channel::endsWith);
    }

    private Object messageOf(LCMDataInputStream in) throws IOException {
        if (channel.endsWith("_STATUS")) return new status_t(in);
        if (channel.endsWith("_FRAME")) return new frame_t(in);
        if (channel.endsWith("_SCAN")) return new planar_lidar_t(in);
        if (channel.endsWith("_CAMERA_INFO")) return new camera_info_t(in);
        if (channel.endsWith("_DEPTH")) return new depth_rows_t(in);
        return new pointcloud_t(in);
    }

    private void show(Object message) {
        shown++;
        if (System.nanoTime() < next) return;  // 5 Hz is enough for a reader; a cloud has thousands of fields
        next = System.nanoTime() + 200_000_000;
        double seconds = (System.nanoTime() - begin) * 1e-9;
        String title = seconds > 1
            ? channel + String.format(Locale.ROOT, " %.1f messages/s, %d ignored", shown / seconds, rows.ignored)
            : window.getTitle();
        if (seconds > 1) {
            begin = System.nanoTime();
            shown = 0;
        }
        SwingUtilities.invokeLater(() -> {
            window.setTitle(title);
            fields.setObject(message, System.currentTimeMillis() * 1000);
        });
    }

    private void showProblem(String problem) {
        if (System.nanoTime() < next) return;
        next = System.nanoTime() + 200_000_000;
        SwingUtilities.invokeLater(() -> panel.show(null, problem));
    }

    private void show(BufferedImage image) {
        if (image == null) return;
        shown++;
        total++;
        double seconds = (System.nanoTime() - begin) * 1e-9;
        String text = window.getTitle().substring(Math.min(channel.length(), window.getTitle().length()));
        if (seconds > 1) {
            text = String.format(Locale.ROOT, " %dx%d %.1f frames/s %d rows lost", image.getWidth(), image.getHeight(),
                                 shown / seconds, rows.rowsLost);
            begin = System.nanoTime();
            shown = 0;
        }
        String line = text;
        SwingUtilities.invokeLater(() -> {
            window.setTitle(channel + line);
            panel.show(image, line + "   " + total + " frames, " + rows.ignored + " messages ignored");
        });
    }

    /** Returns a gray or JPEG image; null for other formats and invalid messages. */
    static BufferedImage imageOf(image_t m) throws IOException {
        if (m.width <= 0 || m.width > MAX_SIDE || m.height <= 0 || m.height > MAX_SIDE) return null;
        if (m.pixelformat == MJPEG) return ImageIO.read(new ByteArrayInputStream(m.data));
        if (m.pixelformat != GRAY || m.row_stride != m.width || m.data.length != m.width * m.height) return null;
        BufferedImage image = new BufferedImage(m.width, m.height, BufferedImage.TYPE_BYTE_GRAY);
        image.getRaster().setDataElements(0, 0, m.width, m.height, m.data);
        return image;
    }
}
