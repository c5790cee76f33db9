# SPDX-License-Identifier: BSD-3-Clause
"""Prints the latency of frames: frame_times.py FRAMES PREFIX"""
import sys
import lcm
from stereod import frame_t

bus = lcm.LCM()
def show(channel, data):
    frame = frame_t.decode(data)
    print(f"frame {frame.frame}: {frame.latency_us / 1000:.2f} ms")
bus.subscribe(sys.argv[2] + "_FRAME", show)
for _ in range(int(sys.argv[1])):
    bus.handle()
