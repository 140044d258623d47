"""Writes gpu.md, a table of the results in gpu.json and, if it exists, mitsuba.json, into their folder."""

from __future__ import annotations

import json
import sys
from pathlib import Path


def rows(results: dict, peer: dict) -> list[tuple[str, str, str]]:
    """Returns name and value of each result, and the peer's value with the ratio, or an empty text.

    results: of realcam bench; peer: of against_mitsuba.py.
    """
    table: list[tuple[str, str, str]] = []

    def add(name: str, value: float, unit: str, peer_value: float | None = None) -> None:
        ratio = f"{peer_value} {unit} ({value / peer_value:.2f} times)" if peer_value else ""
        table.append((name, f"{value} {unit}", ratio))

    for name, r in results["gpu-lens-rays"]["giga_rays_per_second"].items():
        add(f"{name}, {r['surfaces']} surfaces: traced", r["traced"], "G rays/s")
        add(f"{name}: with film and pupil samples ({100 * r['passed_share']:.1f} % pass)", r["generated"], "G rays/s")
    hits = results["gpu-hits"]
    for kind, rate in hits["giga_rays_per_second"].items():
        add(
            f"closest hits, {kind}, {hits['triangles']} triangles",
            rate,
            "G rays/s",
            peer.get("closest_hits", {}).get(kind),
        )
    for triangles, seconds in hits["build_seconds"].items():
        add(f"hierarchy of {triangles} triangles, built", seconds, "s")
    paths = results["gpu-paths"]
    for model, rate in paths["giga_paths_per_second"].items():
        peer_rate = peer.get("paths", {}).get({"pinhole": "perspective", "thin": "thinlens"}.get(model, ""))
        add(f"camera and shadow ray, {model}, 1920 x 1280 x 256", rate, "G paths/s", peer_rate)
    for bounces, rate in paths["giga_rays_per_second_by_bounces"].items():
        add(f"rays of all kinds, full lens, up to {bounces} bounces", rate, "G rays/s")
    add("camera and shadow ray, full lens over thin lens, time", paths["full_over_thin"], "")
    add("lens rays alone over the whole, time", paths["lens_share"], "")
    for change, rate in results["gpu-frames"]["frames_per_second"].items():
        add(f"live view, 640 x 640 x 20, {change} changes", rate, "frames/s")
    add("live view, a frame of minutes stopped", results["gpu-frames"]["milliseconds_to_stop"], "ms")
    objects = results["gpu-objects"]
    for kind, rate in objects["giga_paths_per_second"].items():
        add(f"103 spheres as {kind}, pinhole, camera and shadow ray", rate, "G paths/s")
    for kind, rate in objects["giga_bounces_per_second"].items():
        add(f"103 spheres as {kind}, closest hits, cosine", rate, "G rays/s")
    add("live view, 640 x 640 x 20, one of 103 objects moves", objects["frames_per_second"], "frames/s")
    return table


def main(folder: Path) -> None:
    record = json.loads((folder / "gpu.json").read_text())
    peer_file = folder / "mitsuba.json"
    peer = json.loads(peer_file.read_text()) if peer_file.exists() else {}
    machine = record["machine"]
    lines = [
        f"Device: {machine['devices'][-1]}; commit {machine['commit']}, {machine['date']}.",
        "",
        f"| what | realcam | {peer.get('name', 'peer')} |",
        "|---|---|---|",
    ]
    lines += [f"| {name} | {value} | {peer_value} |" for name, value, peer_value in rows(record["results"], peer)]
    text = "\n".join(lines) + "\n"
    (folder / "gpu.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
