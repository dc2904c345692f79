#!/usr/bin/env python3
"""A farm of many workers, by discrete events: where does rank 0 saturate?

Workers ask rank 0 for a task, compute it, and hand its record in; rank 0 does one thing at a time.
Costs of tasks are drawn from those measured of f08's lines, scaled to the mean asked for. Without arguments it prints the table of scaling.md; it needs nothing but Python.

  scaling_model.py [--service=SECONDS] [--tasks=PER_WORKER]
"""
import argparse
import heapq
import random

# Processor time of f08's lines over their mean, in twenty equal shares (200 lines, mean 0.074 s,
# the slowest 10 times that).
MEASURED = (0.34, 0.36, 0.39, 0.41, 0.47, 0.67, 0.70, 0.71, 0.74, 0.77,
            0.79, 0.86, 0.97, 1.09, 1.12, 1.18, 1.34, 1.50, 1.80, 3.80)


def run(workers, mean, service, tasks_each, seed=1):
    """Efficiency of the workers, and the share of its time that rank 0 is busy."""
    draw = random.Random(seed)
    scale = mean * len(MEASURED) / sum(MEASURED)
    left = workers * tasks_each
    # Everybody asks at once at the beginning: the worst case.
    asking = [(0.0, w) for w in range(workers)]
    free = busy = computed = end = 0.0
    while asking:
        at, worker = heapq.heappop(asking)
        free = max(free, at) + service
        busy += service
        if left == 0:
            continue
        left -= 1
        seconds = scale * draw.choice(MEASURED)
        computed += seconds
        end = max(end, free + seconds)
        heapq.heappush(asking, (free + seconds, worker))
    return computed / (workers * end), min(1.0, busy / end)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--service", type=float, default=1e-3,
                        help="seconds of rank 0 for a task: question, answer, record (1e-3)")
    parser.add_argument("--tasks", type=int, default=50, help="tasks a worker (50)")
    options = parser.parse_args()
    print("workers  task s  efficiency  rank 0 busy")
    for workers in (100, 1000, 10000):
        for mean in (0.074, 1.0, 3.0, 10.0, 30.0):
            efficiency, busy = run(workers, mean, options.service, options.tasks)
            print(f"{workers:7d}  {mean:6.3g}  {efficiency:9.2f}  {busy:10.2f}")


if __name__ == "__main__":
    main()
