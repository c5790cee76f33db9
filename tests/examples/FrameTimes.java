// SPDX-License-Identifier: BSD-3-Clause
// Prints the latency of frames:
//   FrameTimes FRAMES PREFIX
import java.util.concurrent.CountDownLatch;
import lcm.lcm.LCM;
import stereod.frame_t;

public class FrameTimes {
    public static void main(String[] arguments) throws Exception {
        CountDownLatch frames = new CountDownLatch(Integer.parseInt(arguments[0]));
        LCM.getSingleton().subscribe(arguments[1] + "_FRAME", (lcm, channel, data) -> {
            try {
                frame_t frame = new frame_t(data);
                System.out.printf("frame %d: %.2f ms%n", frame.frame, frame.latency_us / 1000.0);
                frames.countDown();
            } catch (java.io.IOException notOfStereod) { /* a message of another program */ }
        });
        frames.await();
        System.exit(0);
    }
}
