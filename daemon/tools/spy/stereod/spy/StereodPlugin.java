// SPDX-License-Identifier: BSD-3-Clause
// The plugin that lcm-spy loads: a right click on a channel with disparity rows or images offers to show the image.
package stereod.spy;

import java.awt.event.ActionEvent;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;
import stereod.disparity_rows_t;
import stereod.image_t;

public class StereodPlugin implements SpyPlugin {
    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == disparity_rows_t.LCM_FINGERPRINT || fingerprint == image_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData data) {
        return new AbstractAction("Image of " + data.name) {
            @Override
            public void actionPerformed(ActionEvent event) {
                new ChannelWindow(data.name, 700, 40);
            }
        };
    }
}
