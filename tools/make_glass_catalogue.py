#!/usr/bin/env python3
"""Write lenses/glass.toml, the glass catalogue, from the makers' published data.

    pip install opticalglass scipy
    python tools/make_glass_catalogue.py [--opticalglass DIR] [--agf schott=FILE] [--agf hoya=FILE] > lenses/glass.toml
    python tools/make_glass_catalogue.py --extend DIR      # changes lenses/glass.toml

The package `opticalglass` (BSD) contains the makers' data sheets. DIR is the folder in which it is
installed, if that is not on the path. An AGF file, the catalogue format of lens-design programs, adds
the glasses that a maker no longer lists; the data sheet has precedence.

`--extend` adds missing materials to the file: those of OTHERS, and the glasses of DIR, the folder
data-nk/glass of the refractiveindex.info database (public domain), which has the makers' AGF
catalogues of 2017 and later. The wheel of `optiland` contains it as optiland/database/data-nk/glass.
A glass is omitted if another maker has one of the same name, so that names in lens files remain
unambiguous.

The Sellmeier coefficients of Schott and Ohara are copied. Hoya, CDGM, Hikari and Sumita publish n^2
as a power series of the wavelength; a three-term Sellmeier formula is fitted to that series from 365
to 850 nm. If the error of the fit exceeds FIT_TOLERANCE anywhere from 380 to 780 nm, the glass is
written as a table of the series' values.
"""

import argparse
import re
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

FIT_TOLERANCE = 5e-6  # in index; the makers print indices to 1e-5
D_LINE_UM = 0.5875618
# Wavelengths of the fit, with n_d weighted so that it is preserved to 1e-6.
FIT_UM = np.concatenate([np.linspace(0.365, 0.85, 80), np.full(200, D_LINE_UM)])
VISIBLE_UM = np.linspace(0.380, 0.780, 201)
TABLE_NM = [365, 380, 400, 420, 440, 460, 480, 500, 530, 560, 590, 620, 660, 700, 740, 780, 850, 1014]
# Start values of the three C, in um^2.
STARTS = ([0.008, 0.03, 100.0], [0.01, 0.05, 110.0], [0.005, 0.02, 60.0], [0.012, 0.06, 150.0])

# Catalogue, name in opticalglass, formula ("sellmeier", or powers of the wavelength in um in the series of n^2), and
# edition of the data sheet.
MAKERS = [
    ("schott", "Schott", "sellmeier", "Schott, optical glass data sheet, 1 June 2018"),
    ("ohara", "Ohara", "sellmeier", "Ohara, recommended and low-Tg glasses, May 2018"),
    ("hoya", "Hoya", [0, 2, -2, -4, -6, -8], "Hoya, data table 15 December 2018"),
    ("cdgm", "CDGM", [0, 2, -2, -4, -6, -8], "CDGM, catalogue September 2018"),
    ("hikari", "Hikari", [0, 2, 4, -2, -4, -6, -8, -10, -12], "Hikari (Nikon), data 1 April 2020"),
    ("sumita", "Sumita", [0, 2, -2, -4, -6, -8], "Sumita, Ver. 12.00.05, 29 July 2020"),
]

# Materials that no glass maker lists, by their names in the catalogues of lens-design programs: source, names, B, and C
# in um^2. A constant is a term with C = 0. For birefringent crystals the ordinary index is given. Germanium and silicon
# are omitted, because their formulas have no index in the visible, and barium fluoride, because Hoya has a BAF2.
OTHERS = [
    (
        "Fused silica: I. H. Malitson, J. Opt. Soc. Am. 55, 1205 (1965), at 20 C, 0.21 to 3.71 um",
        ("SILICA", "F_SILICA"),
        [0.6961663, 0.4079426, 0.8974794],
        [0.0684043**2, 0.1162414**2, 9.896161**2],
    ),
    (
        "Calcium fluoride: I. H. Malitson, Appl. Opt. 2, 1103 (1963), at 24 C, 0.23 to 9.7 um",
        ("CAF2",),
        [0.5675888, 0.4710914, 3.8484723],
        [0.050263605**2, 0.1003909**2, 34.649040**2],
    ),
    (
        "Magnesium fluoride: M. J. Dodge, Appl. Opt. 23, 1980 (1984), at 19 C, 0.2 to 7 um",
        ("MGF2",),
        [0.48755108, 0.39875031, 2.3120353],
        [0.04338408**2, 0.09461442**2, 23.793604**2],
    ),
    (
        "Lithium fluoride: H. H. Li, J. Phys. Chem. Ref. Data 5, 329 (1976), at 24 C, 0.1 to 11 um",
        ("LIF",),
        [0.92549, 6.96747],
        [0.07376**2, 32.790**2],
    ),
    (
        "Sapphire: I. H. Malitson, M. J. Dodge, J. Opt. Soc. Am. 62, 1405 (1972), at 20 C, 0.2 to 5 um",
        ("SAPPHIRE", "AL2O3"),
        [1.4313493, 0.65054713, 5.3414021],
        [0.0726631**2, 0.1193242**2, 18.028251**2],
    ),
    (
        "Zinc selenide: D. T. F. Marple, J. Appl. Phys. 35, 539 (1964), 0.48 to 2.5 um",
        ("ZNSE",),
        [3.0, 1.9],
        [0.0, 0.113],
    ),
    (
        "Zinc sulphide: M. Debenham, Appl. Opt. 23, 2238 (1984); C. A. Klein, 25, 1873 (1986), at 20 C, 0.41 to 13 um",
        ("ZNS", "CLEARTRAN"),
        [8.393 - 1 - 0.14383 / 0.2421**2 - 4430.99 / 36.71**2, 0.14383 / 0.2421**2, 4430.99 / 36.71**2],
        [0.0, 0.2421**2, 36.71**2],
    ),
]

# Cements, by a power series: coefficients of 1, l^-2, l^-4 in um.
CEMENTS = {
    "Optical cement: Norland Products, NOA 61": ("NOA61", [1.5375, 0.00829045, -0.000211046]),
}

# Plastics have only n_d and V_d, because samples differ by 1e-3 in index and by several units in V_d.
PLASTICS = (
    "Optical plastics: n_d and V_d as makers state them, and lens-design programs have them under these names",
    {
        "PMMA": (1.4918, 57.44),
        "ACRYLIC": (1.4917, 55.31),
        "POLYCARB": (1.5855, 29.91),
        "POLYSTYR": (1.5905, 30.87),
        "SAN": (1.5673, 34.81),
        "COC": (1.5337, 56.23),
        "E48R": (1.5312, 56.04),
        "ZEONEX-E48R": (1.5312, 56.04),
    },
)


def sellmeier_index(b, c, um):
    """Refractive index by n^2 = 1 + sum B l^2 / (l^2 - C) at wavelengths in um."""
    um2 = np.asarray(um) ** 2
    return np.sqrt(1 + sum(bi * um2 / (um2 - ci) for bi, ci in zip(b, c, strict=True)))


def series_index(coefficients, powers, um):
    """Refractive index by n^2 = sum a l^p at wavelengths in um."""
    return np.sqrt(sum(a * np.asarray(um) ** p for a, p in zip(coefficients, powers, strict=True)))


def fit_sellmeier(coefficients, powers):
    """(B, C, largest index error from 380 to 780 nm) of the best three-term Sellmeier fit; None if no fit is finite."""
    target = series_index(coefficients, powers, FIT_UM) ** 2 - 1
    um2 = FIT_UM**2

    def linear(log_c):
        """The best B for these C, by linear least squares, and the residuals."""
        a = np.stack([um2 / (um2 - ci) for ci in np.exp(log_c)], axis=1)
        b = np.linalg.lstsq(a, target, rcond=None)[0]
        return b, a @ b - target

    best = None
    for start in STARTS:
        fit = least_squares(
            lambda q: 1e6 * linear(q)[1],
            np.log(start),
            method="trf",
            bounds=(np.log([1e-4, 5e-3, 5.0]), np.log([0.03, 0.11, 1000.0])),
        )
        b, c = linear(fit.x)[0], np.exp(fit.x)
        b, c = [float(f"{v:.9g}") for v in b], [float(f"{v:.9g}") for v in c]
        error = np.abs(sellmeier_index(b, c, VISIBLE_UM) - series_index(coefficients, powers, VISIBLE_UM)).max()
        if np.isfinite(error) and (best is None or error < best[2]):
            best = (b, c, error)
    return best


def number(v):
    """Number with nine digits, as TOML."""
    return repr(float(f"{float(v):.9g}"))


def sellmeier_line(b, c):
    """TOML of a Sellmeier formula."""
    first, second = (", ".join(map(number, values)) for values in (b, c))
    return f"sellmeier = {{B=[{first}], C=[{second}]}}"


def glasses_of_maker(name, formula):
    """Yields (name, coefficients, formula, printed index at d) of a maker's data sheet in opticalglass."""
    from opticalglass.glassfactory import get_glass_catalog

    catalogue = get_glass_catalog(name)
    for glass in catalogue.get_glass_names():
        row = catalogue.df.loc[glass]
        try:
            coefficients = [float(v) for v in catalogue.create_glass(glass, name).coefs]
        except ValueError:  # Hikari prints "-" for a coefficient that is zero
            coefficients = [0.0 if str(v) == "-" else float(v) for v in row["dispersion coefficients"]]
        yield str(glass).replace(" ", ""), coefficients, formula, float(row["refractive indices"]["d"])


def glasses_of_agf(path):
    """Yields (name, coefficients, formula, printed index at d) of an AGF file's glasses with a supported formula."""
    raw = Path(path).read_bytes()
    text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "latin-1").replace("\0", "")
    name = kind = index = None
    for line in text.splitlines():
        words = line.split()
        if line.startswith("NM "):
            name, kind, index = words[1], int(float(words[2])), float(words[4])
        elif line.startswith("CD ") and name:
            c = [float(v) for v in words[1:]]
            if kind == 2:
                yield name, c[0:6:2] + c[1:6:2], "sellmeier", index
            elif kind == 1:
                yield name, c[:6], [0, 2, -2, -4, -6, -8], index
            name = None


def glass_line(coefficients, formula):
    """Returns the TOML of a glass, its index at d, and its origin: "copied", "fitted" or "table"."""
    if formula == "sellmeier":
        b, c = coefficients[:3], coefficients[3:6]
        return sellmeier_line(b, c), float(sellmeier_index(b, c, D_LINE_UM)), "copied"
    powers = formula[: len(coefficients)]
    n_d = float(series_index(coefficients, powers, D_LINE_UM))
    fit = fit_sellmeier(coefficients, powers)
    if fit and fit[2] <= FIT_TOLERANCE:
        return sellmeier_line(fit[0], fit[1]), n_d, "fitted"
    rows = ", ".join(f"[{nm}, {float(series_index(coefficients, powers, nm / 1000)):.6f}]" for nm in TABLE_NM)
    return f"table = [{rows}]", n_d, "table"


def glasses_of_database(folder):
    """Yields (name, coefficients, formula, printed index at d, source) of a maker's glasses in the refractiveindex.info
    database."""
    for path in sorted(folder.glob("*.yml"), key=lambda p: p.stem.upper()):
        text = path.read_text(encoding="utf-8")
        found = re.search(r"type: formula (\d+)\s+wavelength_range:.*\s+coefficients: (.*)", text)
        printed = re.search(r"^ +nd: (\S+)", text, re.MULTILINE)
        source = re.search(r"REFERENCES: \"<a href=[^>]*>([^<]*)</a>", text)
        if not (found and printed and source):
            continue
        c = [float(v) for v in found[2].split()]
        if found[1] in ("1", "2") and c[0] == 0 and len(c) == 7:
            roots = c[2::2]
            yield (
                path.stem,
                c[1::2] + [v * v if found[1] == "1" else v for v in roots],
                "sellmeier",
                float(printed[1]),
                source[1],
            )
        elif found[1] == "3":
            yield path.stem, c[:1] + c[1::2], [0] + [int(p) for p in c[2::2]], float(printed[1]), source[1]


def bare(name):
    """Name without separators and case, for comparison."""
    return re.sub("[-_ ]", "", name).upper()


def plastics_lines():
    """TOML lines of the plastics."""
    title, plastics = PLASTICS
    return [f"# {title}", *(f'"{name}" = {{ n_d = {n_d}, V_d = {v_d} }}' for name, (n_d, v_d) in plastics.items())]


def cement_lines():
    """TOML lines of the cements."""
    entries = [(f"# {title}", f'"{name}" = {{ cauchy = {a} }}') for title, (name, a) in CEMENTS.items()]
    return [line for entry in entries for line in entry]


def extend(catalogue, database):
    """Adds missing materials to a catalogue file, whose existing entries are not changed.

    database: the folder data-nk/glass.
    """
    head, *sections = re.split(r"\n(?=\[)", catalogue.read_text(encoding="utf-8"))
    makers = {re.match(r"\[(\w+)\]", section)[1]: section.rstrip("\n").split("\n") for section in sections}
    owners = {}
    for maker, lines in makers.items():
        for name in re.findall(r'^"([^"]+)" =', "\n".join(lines), re.MULTILINE):
            owners.setdefault(bare(name), set()).add(maker)
    candidates = {maker: list(glasses_of_database(database / maker)) for maker, *_ in MAKERS}
    for names in [*(names for _, names, *_ in OTHERS), PLASTICS[1], [name for name, _ in CEMENTS.values()]]:
        for name in names:
            owners.setdefault(bare(name), set()).add("misc")
    for maker, glasses in candidates.items():
        for name, *_ in glasses:
            owners.setdefault(bare(name), set()).add(maker)
    counts = dict.fromkeys(("copied", "fitted", "table"), 0)
    for maker, glasses in candidates.items():
        added = {}
        known = {bare(name) for name in re.findall(r'^"([^"]+)" =', "\n".join(makers[maker]), re.MULTILINE)}
        for name, coefficients, formula, printed, source in glasses:
            if bare(name) in known or len(owners[bare(name)]) > 1:
                continue
            toml, n_d, made = glass_line(coefficients, formula)
            if not (1.3 < n_d < 2.3) or abs(printed - n_d) > 3e-5:
                print(f"{maker}:{name} omitted: the formula gives {n_d:.6f}, the database {printed}", file=sys.stderr)
                continue
            counts[made] += 1
            added.setdefault(source, []).append(f'"{name}" = {{ {toml} }}')
        for source, lines in added.items():
            makers[maker] += [f"# refractiveindex.info database, {source}", *lines]
    for title, names, b, c in OTHERS:
        lines = [f'"{name}" = {{ {sellmeier_line(b, c)} }}' for name in names]
        if lines[0] not in makers["misc"]:
            makers["misc"] += [f"# {title}", *lines]
            counts["copied"] += len(lines)
    for lines in (plastics_lines(), cement_lines()):
        if lines[0] not in makers["misc"]:
            makers["misc"] += lines
    head = re.sub(r"(\d+) (copied|fitted|table)", lambda m: f"{int(m[1]) + counts[m[2]]} {m[2]}", head)
    sections = ["\n".join(lines) + "\n" for lines in makers.values()]
    catalogue.write_text("\n".join([head, *sections]), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--opticalglass", metavar="DIR", help="folder in which the package opticalglass is installed")
    parser.add_argument(
        "--agf",
        action="append",
        default=[],
        metavar="CATALOGUE=FILE",
        help="a maker's AGF catalogue, for glasses that the data sheet no longer lists",
    )
    parser.add_argument("--extend", metavar="DIR", help="add glasses of this folder that lenses/glass.toml lacks")
    options = parser.parse_args()
    if options.extend:
        return extend(Path(__file__).parents[1] / "lenses" / "glass.toml", Path(options.extend))
    if options.opticalglass:
        sys.path.insert(0, options.opticalglass)

    lines, seen, counts, problems = [], set(), {}, []
    extra = dict(pair.split("=", 1) for pair in options.agf)
    for catalogue, maker, formula, edition in MAKERS:
        sources = [(edition, glasses_of_maker(maker, formula))]
        if catalogue in extra:
            text = Path(extra[catalogue]).read_bytes().split(b"\n", 1)[0].decode("latin-1")
            first = re.sub(r"^[\sÿþ!C]+|\s+$", "", text.replace("\0", ""))
            sources.append(
                (
                    f"{maker}, AGF catalogue: {first}" if first else f"{maker}, AGF catalogue",
                    glasses_of_agf(extra[catalogue]),
                )
            )
        lines.append(f"\n[{catalogue}]")
        for title, glasses in sources:
            lines.append(f"# {title}")
            for name, coefficients, form, printed in glasses:
                if (catalogue, name.upper()) in seen or not re.fullmatch(r"[A-Za-z0-9._()+-]+", name):
                    continue
                toml, n_d, made = glass_line(coefficients, form)
                if not (1.3 < n_d < 2.3) or (printed and abs(printed - n_d) > 3e-5):
                    problems.append(
                        f"{catalogue}:{name} omitted: the formula gives {n_d:.6f}, the data sheet {printed}"
                    )
                    continue
                seen.add((catalogue, name.upper()))
                counts[made] = counts.get(made, 0) + 1
                lines.append(f'"{name}" = {{ {toml} }}')
    lines.append("\n[misc]")
    for title, names, b, c in OTHERS:
        lines.append(f"# {title}")
        lines += [f'"{name}" = {{ {sellmeier_line(b, c)} }}' for name in names]
        counts["copied"] = counts.get("copied", 0) + len(names)
    lines += plastics_lines() + cement_lines()
    print(
        "\n".join(
            [
                "# Glass catalogue, written by tools/make_glass_catalogue.py; do not edit by hand.",
                "# Indices relative to air at 20 to 25 C as the makers publish them; wavelengths in um in the formulas",
                "# (n^2 = 1 + sum B l^2 / (l^2 - C), C in um^2) and nm in the tables.",
                "# Schott, Ohara and misc: the published Sellmeier coefficients. Hoya, CDGM, Hikari, Sumita: Sellmeier",
                f"# formulas fitted to the makers' power series, within {FIT_TOLERANCE:g} in index from 380 to 780 nm,",
                "# else tables of the series.",
                "# " + ", ".join(f"{v} {k}" for k, v in sorted(counts.items())) + ".",
                "format = 1",
                *lines,
            ]
        )
    )
    for p in problems:
        print(p, file=sys.stderr)


if __name__ == "__main__":
    main()
