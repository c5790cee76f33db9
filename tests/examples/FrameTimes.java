// Prints how long each frame took and how far the way ahead is free, for as many frames as the command line says.
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
            } catch (java.io.IOException notOurs) { /* another program's message */ }
        });
        frames.await();
        System.exit(0);
    }
}
