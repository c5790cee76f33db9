// A image with a line of text below it.
package stereod.spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.image.BufferedImage;
import javax.swing.JPanel;

class PicturePanel extends JPanel {
    private static final int TEXT_HEIGHT = 22;
    private BufferedImage picture;
    private String text = "waiting for messages";

    PicturePanel() {
        setBackground(new Color(0x14171c));
        setPreferredSize(new Dimension(640, 480 + TEXT_HEIGHT));
    }

    void show(BufferedImage newPicture, String newText) {
        picture = newPicture;
        text = newText;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics g) {
        super.paintComponent(g);
        int height = getHeight() - TEXT_HEIGHT;
        if (picture != null && height > 0) {
            double scale = Math.min((double) getWidth() / picture.getWidth(), (double) height / picture.getHeight());
            g.drawImage(picture, 0, 0, (int) (scale * picture.getWidth()), (int) (scale * picture.getHeight()), null);
        }
        g.setColor(Color.LIGHT_GRAY);
        g.drawString(text, 6, getHeight() - 7);
    }
}
