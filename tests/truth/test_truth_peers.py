"""Side by side with Optiland and ray-optics: 200 random lenses and every bundled one, mirrors and fisheyes too.

The peers' figures are in peer_rays.json.gz (see peer_file.py); where the peers are installed, they are asked again.
Where two programs contradict each other, the oracle decides: 50 digits, straight from the textbook. It sided with
realcam each time. The peers' faults, in Optiland 0.6.3 and ray-optics 0.9.8:

- Neither looks whether its search for an asphere's point has converged (Optiland's
  NewtonRaphsonGeometry._solve_distance_primal, ray-optics' SurfaceProfile.intersect_spencer). It takes what it has
  after 100 or 1000 steps, be it 1 mm off; so rays that do not meet the surface at all pass, or end elsewhere.
- Optiland starts that search on the base conic. A ray that does not meet the base conic is lost, though it meets the
  asphere: at surface 10 of phone-4mm that is 6 rays of 40.
- Of a batch of rays, Optiland's search has one tolerance, which grows with the longest distance in it
  (_effective_tolerance). A ray that hardly meets a base conic raised it to 1 mm for all the others, which were then
  0.03 mm off. The adapter gives aspheric lenses one ray at a time.
- Optiland's factory of surfaces gives aspheres a tolerance of 1e-6 mm, which leaves 1e-6 mm and 2e-7 in direction.
  The class's own 1e-10 mm still leaves 1.3e-11. The adapter asks for 1e-15.
- ray-optics' exp_dist takes for granted that its image surface stands in the paraxial image, and with an object at
  infinity, for it 1e10 mm, its pupils have 5e-5 mm of rounding. The adapter takes its chief ray instead, and an object
  near by.

Optiland's wrong choice between a conic's two intersections (github.com/optiland/optiland, issues 329 and 787) is
mended in this version, and did not show.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from ..centred_lenses import CENTRED
from ..measurement import Measurement, breaks, hold
from . import backends, comparison, oracle, peer_file, peers, random_lenses, random_rays
from .peer_file import Case
from .prescription import Rays, Traced

SECTION = "Other programs"

# 1 pm, a millionth of a wavelength, and the angle of 1 pm over 100 mm. Doubles leave 1e-12 mm and 1e-14 after twenty
# surfaces, so that a wrong formula shows and rounding does not. Figures of first order are lengths of 1e-2 to 1e4 mm,
# from sums of longer ones: 1e-9 leaves three digits for what cancels.
POSITION_MM = OPTICAL_PATH_MM = 1e-9
DIRECTION = 1e-11
FIRST_ORDER = 1e-9

# mm behind the last surface, for rays on their way back
BEHIND = 5.0

VERSIONS, CASES = peer_file.read()


@functools.cache
def traced(backend: str) -> list[Traced]:
    return [backends.trace(case.lens, case.rays, backend) for case in CASES]


def hold_differences(found: list[comparison.Differences], what: str, tried: str, backend: str) -> None:
    worst = comparison.worst(found)
    for quantity, value, limit, unit in (
        ("position", worst.position, POSITION_MM, "mm"),
        ("direction", worst.direction, DIRECTION, "of a unit vector"),
        ("optical path", worst.optical_path, OPTICAL_PATH_MM, "mm"),
    ):
        hold(Measurement(SECTION, f"{quantity} of rays {what}", tried, backend, "float64", float(value), limit, unit))


def tried(cases: list[Case], rays: int) -> str:
    random = sum(case.is_random for case in cases)
    return f"{random} random and {len(cases) - random} bundled lenses, {rays} rays that pass"


def test_the_file_holds_what_it_should() -> None:
    assert set(VERSIONS) == set(peers.PEERS)
    assert sum(case.is_random for case in CASES) == 200
    assert {len(case.lens.rows) - 1 for case in CASES if case.is_random} >= set(range(1, 21))
    bundled = {case.lens.name: case.lens for case in CASES if not case.is_random}
    # A bundled lens that is new or changes wants tools/make_peer_rays.py again.
    assert set(bundled) == set(CENTRED)
    for name, lens in bundled.items():
        now = backends.of_bundled_lens(name).rows
        assert [replace(row, index=1.0) for row in lens.rows] == [replace(row, index=1.0) for row in now], name
        # Glass catalogues take no part here: the rays are those of the file's indices.
        assert [row.index for row in lens.rows] == pytest.approx([row.index for row in now], abs=1e-5), name


def test_most_rays_pass(backend: str) -> None:
    passed = np.concatenate([rays.ok for rays in traced(backend)])
    assert passed.mean() > 0.7
    fates = np.concatenate([rays.fates for rays in traced(backend)])
    assert set(fates) == {"ok", "missed", "vignetted", "total internal reflection"}


@pytest.mark.parametrize("peer", peers.PEERS)
def test_rays(peer: str, backend: str) -> None:
    found = [
        comparison.between(ours, case.opinions[peer].rays) for case, ours in zip(CASES, traced(backend), strict=True)
    ]
    rays = sum(len(d.position) for d in found)
    assert rays > 3500
    hold_differences(found, f"against {peer} {VERSIONS[peer]}", tried(CASES, rays), backend)


@pytest.mark.parametrize("peer", peers.PEERS)
def test_rays_on_their_way_back(peer: str, backend: str) -> None:
    """The peer's rays behind the lens are turned round, and must leave the lens as the peer's had entered it."""
    found = []
    for case in CASES:
        theirs = case.opinions[peer].rays
        ok, index = theirs.ok, case.lens.rows[-1].index
        turned = Rays((theirs.positions + BEHIND * theirs.directions)[ok], -theirs.directions[ok])
        back = backends.trace(case.lens, turned, backend, start="film")
        assert back.ok.all(), case.lens.name
        back.optical_paths[:] -= theirs.optical_paths[ok] + index * BEHIND
        found.append(comparison.of_return(case.rays[ok], back))
    rays = sum(len(d.position) for d in found)
    hold_differences(found, f"on their way back, against {peer} {VERSIONS[peer]}", tried(CASES, rays), backend)


def unsettled(cases: list[Case], ours: list[Traced], peer: str) -> tuple[int, list[str]]:
    """How many contradictions there are, and those in which the oracle is not on realcam's side."""
    count, lost = 0, []
    for case, mine in zip(cases, ours, strict=True):
        rays = comparison.contradictions(mine, case.opinions[peer].rays)
        if not len(rays):
            continue
        judge = oracle.trace(case.lens, case.rays[rays])
        for k, i in enumerate(rays):
            count += 1
            same = judge.ok[k] == mine.ok[i] and judge.ended_at[k] == mine.ended_at[i]
            if mine.ok[i] and judge.ok[k]:
                off = comparison.between(mine[[i]], judge[[k]])
                same = (off.position <= POSITION_MM) & (off.direction <= DIRECTION)
                same = bool((same & (off.optical_path <= OPTICAL_PATH_MM)).all())
            if not same:
                lost.append(f"{case.lens.name} ray {i}: {mine.fates[i]}, but {judge.fates[k]} at {judge.ended_at[k]}")
    return count, lost


def hold_contradictions(cases: list[Case], ours: list[Traced], peer: str, against: str, backend: str) -> None:
    count, lost = unsettled(cases, ours, peer)
    rays = sum(len(case.rays) for case in cases)
    assert not lost
    # A contradiction is rare; more of them, and the peer has been used wrongly.
    assert count <= 0.01 * rays
    hold(
        Measurement(
            SECTION,
            f"rays whose fate the oracle sees otherwise than realcam, of those that contradict {against}",
            f"{count} of {rays} rays",
            backend,
            "float64",
            float(len(lost)),
            0.0,
            "rays",
        )
    )


@pytest.mark.parametrize("peer", peers.PEERS)
def test_fates(peer: str, backend: str) -> None:
    hold_contradictions(CASES, traced(backend), peer, f"{peer} {VERSIONS[peer]}", backend)


def hold_first_order(errors: list[float], lenses: int, against: str) -> None:
    what, tried = f"first-order data against {against}", f"{lenses} lenses, {len(errors)} figures"
    hold(Measurement(SECTION, what, tried, "core", "float64", max(errors), FIRST_ORDER, "of the figure"))


def first_order_errors(cases: list[Case], peer: str) -> list[float]:
    errors: list[float] = []
    for case in cases:
        ours = backends.first_order(case.lens)
        errors += comparison.relative(ours, case.opinions[peer].first_order).values()
    return errors


@pytest.mark.parametrize("peer", peers.PEERS)
def test_first_order_data(peer: str) -> None:
    hold_first_order(first_order_errors(CASES, peer), len(CASES), f"{peer} {VERSIONS[peer]}")


def test_oracle(backend: str) -> None:
    """The judge itself, on two rays of every second lens."""
    found = []
    half = CASES[::2]
    for case, ours in zip(half, traced(backend)[::2], strict=True):
        few = np.flatnonzero(ours.ok)[:2]
        judge = oracle.trace(case.lens, case.rays[few])
        assert judge.ok.all(), case.lens.name
        found.append(comparison.between(ours[few], judge))
    hold_differences(found, "against 50 digits", tried(half, sum(len(d.position) for d in found)), backend)


def test_a_slip_in_the_seventh_decimal_shows(backend: str) -> None:
    """In every single lens: what the comparison could miss is smaller."""
    least = np.inf
    for case, rays in zip(CASES, traced(backend), strict=True):
        rows = tuple(replace(row, radius=row.radius * (1 + 1e-7)) for row in case.lens.rows)
        slipped = backends.trace(replace(case.lens, rows=rows), case.rays, backend)
        assert (slipped.ok & rays.ok).any()
        theirs = case.opinions["Optiland"].rays
        least = min(least, comparison.between(slipped, theirs).direction.max())
    what = "direction of rays through lenses whose radii are 1e-7 of themselves too long, the least of all lenses"
    breaks(Measurement(SECTION, what, f"{len(CASES)} lenses", backend, "float64", least, DIRECTION, "of a unit vector"))


LIVE_SEEDS = range(1001, 1031)  # other lenses than those of the file
LIVE_RAYS = 20


def ask(peer: str) -> list[Case]:
    """The peer itself, on new lenses and on new rays through the bundled ones."""
    inputs = []
    for seed in LIVE_SEEDS:
        random, rng = random_lenses.random_lens(seed), np.random.default_rng([seed, 1])
        rays = random_rays.from_the_scene(random.prescription, random.half_field_deg, LIVE_RAYS, rng)
        inputs.append((random.prescription, rays))
    for name in CENTRED:
        rays = random_rays.from_the_film(name, LIVE_RAYS, np.random.default_rng(2))
        inputs.append((backends.of_bundled_lens(name), rays))
    cases = []
    for lens, (origins, directions) in inputs:
        rays = random_rays.unit(origins, directions)
        program = peers.PEERS[peer]
        opinion = peer_file.Opinion(program.first_order(lens), program.trace(lens, rays))
        cases.append(Case(lens, rays, {peer: opinion}))
    return cases


@pytest.mark.slow
@pytest.mark.parametrize("peer", peers.PEERS)
def test_live(peer: str, backend: str) -> None:
    version = peers.version(peer)
    if version is None:
        pytest.skip(f"{peer} is not installed: pip install 'realcam[truth]'")
    cases = ask(peer)
    ours = [backends.trace(case.lens, case.rays, backend) for case in cases]
    found = [comparison.between(mine, case.opinions[peer].rays) for case, mine in zip(cases, ours, strict=True)]
    rays = sum(len(d.position) for d in found)
    hold_differences(found, f"against {peer} {version}, run live", tried(cases, rays), backend)
    hold_contradictions(cases, ours, peer, f"{peer} {version}, run live", backend)
    hold_first_order(first_order_errors(cases, peer), len(cases), f"{peer} {version}, run live")
