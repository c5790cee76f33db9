// SPDX-License-Identifier: BSD-3-Clause
// Starts lcm-spy and opens a window for each channel of the command line.
package stereod.spy;

import javax.swing.SwingUtilities;

public class StereodSpy {
    public static void main(String[] channels) throws Exception {
        lcm.spy.Spy.main(new String[0]);
        SwingUtilities.invokeAndWait(() -> {
            for (int i = 0; i < channels.length; i++) new ChannelWindow(channels[i], 660 * (i % 2), 380 + 40 * i);
        });
    }
}
