// SPDX-License-Identifier: BSD-3-Clause
// Shows an image with a line of text below.
package stereod.spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.image.BufferedImage;
import javax.swing.JPanel;

class ImagePanel extends JPanel {
    private static final int TEXT_HEIGHT = 22;
    private BufferedImage image;
    private String text = "waiting for messages";

    ImagePanel() {
        setBackground(new Color(0x14171c));
        setPreferredSize(new Dimension(640, 480 + TEXT_HEIGHT));
    }

    void show(BufferedImage newImage, String newText) {
        image = newImage;
        text = newText;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics g) {
        super.paintComponent(g);
        int height = getHeight() - TEXT_HEIGHT;
        if (image != null && height > 0) {
            double scale = Math.min((double) getWidth() / image.getWidth(), (double) height / image.getHeight());
            g.drawImage(image, 0, 0, (int) (scale * image.getWidth()), (int) (scale * image.getHeight()), null);
        }
        g.setColor(Color.LIGHT_GRAY);
        g.drawString(text, 6, getHeight() - 7);
    }
}
