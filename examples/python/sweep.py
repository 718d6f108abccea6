#!/usr/bin/python3
"""Sweeps a parameter: the pieces of a plaster board by the speed of a shot, with error bars over seeds.

    sweep.py -o DIR [--speeds V,V,...] [--seeds N]

Writes sweep.csv, and sweep.png by matplotlib, or sweep.svg without it.
"""
import argparse
import csv
import math
from pathlib import Path

import sunder


def pieces_of(speed_m_s, seed):
    """Returns the number of bodies half a second after a shot at a board of plaster."""
    scene = sunder.Scene()
    scene.seed = seed
    world = sunder.World(scene, particles=False)
    world.add_solid(sunder.Asset.from_boxes([((-1, 0, 0), (1, 2, 0.05))], "plaster", anchored=True))
    world.shoot((0, 1.2, 2), (0, 0, -speed_m_s), radius_m=0.1)
    world.run(0.5)
    return len(world) - 1


def mean_and_error(values):
    """Returns the mean, and its standard error."""
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, 0.0
    variance = sum((value - mean) ** 2 for value in values) / (len(values) - 1)
    return mean, math.sqrt(variance / len(values))


def write_svg(path, rows):
    """Draws points with error bars."""
    width, height, edge = 480, 320, 50
    most_x = max(row[0] for row in rows) or 1
    most_y = max(row[1] + row[2] for row in rows) or 1

    def x_of(speed):
        return edge + (width - 2 * edge) * speed / most_x

    def y_of(pieces):
        return height - edge - (height - 2 * edge) * pieces / most_y

    shapes = [f'<path d="M{edge} {edge}V{height - edge}H{width - edge}" fill="none" stroke="black"/>',
              f'<text x="{width / 2}" y="{height - 12}">speed, m/s</text>',
              f'<text x="{edge}" y="{edge - 12}">pieces</text>']
    for speed, mean, error in rows:
        x = x_of(speed)
        shapes.append(f'<path d="M{x:.1f} {y_of(mean - error):.1f}V{y_of(mean + error):.1f}" stroke="black"/>')
        shapes.append(f'<circle cx="{x:.1f}" cy="{y_of(mean):.1f}" r="4" fill="teal"/>')
        shapes.append(f'<text x="{x:.1f}" y="{height - edge + 16}" text-anchor="middle">{speed:g}</text>')
        shapes.append(f'<text x="{x + 8:.1f}" y="{y_of(mean):.1f}">{mean:.0f}</text>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                    f'font-family="sans-serif" font-size="12">{"".join(shapes)}</svg>\n')


def write_plot(folder, rows):
    """Writes the plot. Returns its path."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError:
        write_svg(folder / "sweep.svg", rows)
        return folder / "sweep.svg"
    speeds, means, errors = zip(*rows)
    pyplot.errorbar(speeds, means, errors, fmt="o", capsize=3)
    pyplot.xlabel("speed, m/s")
    pyplot.ylabel("pieces")
    pyplot.savefig(folder / "sweep.png")
    return folder / "sweep.png"


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="DIR")
    parser.add_argument("--speeds", default="5,10,20,40", metavar="V,V,...")
    parser.add_argument("--seeds", type=int, default=5)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for speed in map(float, options.speeds.split(",")):
        counts = [pieces_of(speed, seed) for seed in range(1, options.seeds + 1)]
        rows.append((speed, *mean_and_error(counts)))
        print(f"{speed:g} m/s: {rows[-1][1]:.1f} ± {rows[-1][2]:.1f} pieces")
    with open(options.output / "sweep.csv", "w", newline="", encoding="ascii") as file:
        writer = csv.writer(file)
        writer.writerow(["speed_m_s", "pieces_mean", "pieces_error"])
        writer.writerows(rows)
    print(f"wrote {write_plot(options.output, rows)}")


if __name__ == "__main__":
    main()
