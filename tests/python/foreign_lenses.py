"""Prescriptions of third-party lenses, as facts, in files as Zemax and CODE V write them.

They include the difficulties of such files: glasses that are in no catalogue, mirrors, floating rims, tilts, a near
object, two bytes for each character, and lines and numbers that a reader does not need.
"""

from __future__ import annotations

from pathlib import Path

# For each file: the lines before the surfaces, and a row for each surface:
# curvature | distance | glass | semi-diameter | further operands.
ZEMAX: dict[str, tuple[str, str]] = {
    # Two mirrors without aberrations of the third order: Handbook of Optics, 2nd edition, vol. II, chapter 18.
    "two-mirrors.zmx": (
        """
FNUM 4 0
GCAT SCHOTT
FTYP 0 0 2 1
XFLN 0 0 0
YFLN 0 1 0
PWAV 1
WAVM 0.55 0.55 0.55 0.55
""",
        """
0 | inf |  | 0
0 | 16 |  | 10.29095987097
-0.021872265966754158 | -16 | MIRROR | 10.03088602257 | STOP; CONI -1
-0.052083333333333336 | 24.035 | MIRROR | 3.33669775711 | CONI -3.236
0 | 0 |  | 1.435181192595
""",
    ),
    # Mirrors that are tilted, one of them a torus: the same chapter.
    "tilted-mirrors.zmx": (
        """
ENPD 20
GCAT SCHOTT
FTYP 0 0 3 1
XFLN 0 1 -1
YFLN 0 0 0
PWAV 1
WAVM 0.55 0.55 0.55 0.55
""",
        """
0 | inf |  | 0
0 | 160 |  | 12.792810388514814
0 | 0 |  | 0 | TYPE COORDBRK; PARM 3 -3.5
-0.0009852216748768472 | 0 | MIRROR | 10.021719313230335 | STOP; CONI -4.278
0 | 0 |  | 0 | TYPE COORDBRK; PARM 3 -3.5
0 | -160.36 |  | 10.007006649378345
0 | 0 |  | 0 | TYPE COORDBRK; PARM 3 -3.3200000000000003
0.000956278927437555 | 0 | MIRROR | 9.645120879416348 | TYPE TOROIDAL; PARM 1 1035
0 | 0 |  | 0 | TYPE COORDBRK; PARM 3 3.3200000000000003
0 | 206.80004397784717 |  | 9.64605577567293
0 | 0 |  | 0 | TYPE COORDBRK; PARM 2 24.073899767516576
0 | 0 |  | 5.3137812819569294
""",
    ),
    # US patent 5 331 467, example 1: lenses and mirrors in one, 1000 mm.
    "us5331467-1.zmx": (
        """
FNUM 7.5 0
GCAT SCHOTT HIKARI OHARA SUMITA_AUG2011
FTYP 2 0 3 3
XFLN 0 0 0
YFLN 0 14 21
PWAV 2
WAVM 0.4861327 0.5875618 0.6562725 0.55
""",
        """
0 | inf |  | 0
0.0002595630152812534 | 10 | N-BK7 | 69.30892741211
-0.0016663084103584395 | 98.15 |  | 69.20160564213 | OBSC 0 25 0
-0.005159825597894791 | 15 | N-BK7 | 60.81744342638
-0.0032371783458666086 | -15 | MIRROR | 61.80137536485 | STOP
-0.005159825597894791 | -88.62 |  | 55.9372836428
-0.010483938606055523 | -5 | N-BK7 | 26.7886269203
-0.006784720808738721 | 5 | MIRROR | 25.67224920425
-0.010483938606055523 | 55.46 |  | 25.79839671168
0.014855529971031718 | 3 | J-LAK02 | 19.82502070125
0.0029176890735461885 | 1 | S-FTM16 | 19.71993042918
0.012200924830102123 | 19.3147 |  | 19.21401087725
0.004831828218843163 | 3.35 | E-LAFH3 | 16.49782200558
-0.01695748757864035 | 1.7 | K-SSK1 | 16.45584120455
0.015405472023662804 | 4.5 |  | 15.44972920971
-0.012065345913467338 | 2.25 | K-SSK1 | 15.30265854497
0.016089845698379752 | 27.934 |  | 15.28875404939
0.021164469089292894 | 10 | K-FK5 | 20.06754865683
-0.007793442597398549 | 1.1 |  | 19.85932987038
0.0005896459353052272 | 1.7 | K-SFLD6 | 19.42611240486
0.010074653180064277 | 23.5 |  | 19.1094452912
0.014366164808642683 | 7 | S-FTM16 | 18.87518208057
-0.005088929034884609 | 7.9 |  | 18.49021308775
-0.021538726630481606 | 2.25 | S-LAL10 | 17.19887544133
-0.0014666584533793278 | 75.7409 |  | 17.40342255013
0 | 0 |  | 21.0496048888
""",
    ),
    # US patent 5 831 776, example 1: fused silica at 248 nm, from an object at hand; rims that cross.
    "us5831776-1.zmx": (
        """
OBNA 0.15 0
GCAT SCHOTT MISC
FTYP 3 1 3 1
XFLN 0 0 0
YFLN 0 8 12
PWAV 1
WAVM 0.248 0.55 0.55 0.55
""",
        """
0 | 110.8588354359 |  | 47.99458807792
-0.0013554089695815051 | 27.484 | SILICA | 64.38663937029
-0.0042500906331827525 | 0.916 |  | 67.05649700237
0.004735328295575404 | 36.646 | SILICA | 68.08158477922
-0.002167323437912469 | 0.916 |  | 66.36904457464
0.002423197952494658 | 21.071 | SILICA | 64.16351549816
0.006229012122280491 | 16.197 |  | 59.00127344572
-0.0016552775296240882 | 7.215 | SILICA | 58.81584948835
0.004583209777636411 | 23.941 |  | 58.358909689
-0.0002788573429970416 | 11.978 | SILICA | 59.98393015623
0.003971140924672222 | 47.506 |  | 61.49220522015
-0.01172584505233831 | 11.961 | SILICA | 64.22906941428
0.0017098117719514612 | 9.968 |  | 88.40193588385
0.00024541075748238996 | 35.291 | SILICA | 94.03954310133
-0.006172134663634091 | 0.923 |  | 95.76619664066
0.0015884513234976428 | 41.227 | SILICA | 119.3060466085
-0.00441034366720958 | 0.916 |  | 118.4252812325
0.0019147041427879125 | 27.842 | SILICA | 122.11903648
-0.0017169622130956143 | 0.916 |  | 122.1058411015
0.002359998961600457 | 22.904 | SILICA | 117.2138397374
-0.0007218340359184616 | 0.916 |  | 116.9241558679 | STOP
0.004716113545149714 | 33.646 | SILICA | 104.5886105467
0.0012463085897457468 | 55.304 |  | 99.2988995227
-0.0012877144189375404 | 8.703 | SILICA | 70.4387653335
0.009418608155761175 | 24.09 |  | 60.19150809238
-0.0049829831126702315 | 11.452 | SILICA | 60.90597635875
0.003206912564170321 | 59.54 |  | 60.80783567956
-0.012948738533892029 | 11.772 | SILICA | 62.86259723833
0.00043144301466146914 | 11.862 |  | 83.66160287771
-0.003437774055050451 | 22.904 | SILICA | 82.34668476556
-0.0067404657796663065 | 1.373 |  | 86.64568903861
-0.00017672514625463836 | 41.227 | SILICA | 103.1151122575
-0.0065795620380325 | 0.916 |  | 103.6117215202
0.0014747076576407184 | 32.981 | SILICA | 109.5024752181
-0.0027889801815068303 | 0.916 |  | 109.6460564489
0.0037839600958704134 | 32.814 | SILICA | 104.2679948232
0.0004329588354862067 | 0.916 |  | 101.1205085664
0.00583879893570373 | 29.015 | SILICA | 92.85371485378
0.0027414046683380097 | 0.918 |  | 87.71838871076
0.008820675663755844 | 76.259 | SILICA | 77.22423114006
0.012706770929957737 | 54.304 |  | 44.23668142221
0.020183956580272604 | 18.65 | SILICA | 25.38765751931
0.009106340198299664 | 13.0764789603 |  | 19.24653763959
0 | 0 |  | 12.01117255762
""",
    ),
    # US patent 8 427 765, example 1: a moulded asphere, and floating rims.
    "us8427765-1.zmx": (
        """
FNUM 2.1 0
GCAT SCHOTT HIKARI RPO HOYA
FTYP 3 0 3 3
XFLN 0 0 0
YFLN 0 8 13.6
PWAV 2
WAVM 0.4861327 0.5875618 0.6562725 0.55
""",
        """
0 | inf |  | 0
0.07766990291262135 | 3.34 | J-LAK14 | 7.6 | FLAP 0 7.6 0
0.02824858757062147 | 0.29 |  | 6.88 | FLAP 0 6.88 0
0.07230657989877079 | 1.85 | L-TIM28_MOLD | 6.48 | FLAP 0 6.48 0
0.111781801922647 | 4.25 |  | 5.58 | TYPE EVENASPH; PARM 2 1.10721e-05; PARM 3 1.837e-07; CONI 0.02; FLAP 0 5.58 0
0 | 5.4 |  | 5.2 | STOP
-0.12048192771084336 | 0.65 | SF11 | 5.77 | FLAP 0 5.77 0
-0.018660197798096658 | 0.22 |  | 7 | FLAP 0 7 0
-0.02668801708033093 | 3.62 | TAF3 | 7.53 | FLAP 0 7.53 0
-0.08501232678738417 | 0.12 |  | 8.3 | FLAP 0 8.3 0
0.004847309743092583 | 3.5 | TAFD30 | 10.8 | FLAP 0 10.8 0
-0.03770739064856712 | 21.25417782777 |  | 11 | FLAP 0 11 0
0 | 0 |  | 13.93367289436
""",
    ),
    # Catalogue data of a moulded asphere of 1.49 mm for laser diodes, with its window. In UTF-16.
    "moulded-asphere.zmx": (
        """
ENPD 1.5
GCAT LIGHTPATH SCHOTT
FTYP 0 0 1 1
XFLN 0 0 0
YFLN 0 0 0
PWAV 1
WAVM 1.55 0.55 0.55 0.55
""",
        """
0 | inf |  | 0
1.1821736792829385 | 0.8625269152715 | D-ZK3M 1.601 50.277746 | 0.75 | STOP; TYPE EVENASPH; CONI -0.4776343430417; \
PARM 2 -0.006313587842251; PARM 3 -0.009394960901464; PARM 4 -0.01707674864971; PARM 5 0.008070222726967; \
PARM 6 -0.02139444912229
0 | 0.5232428185297 |  | 0.5741712000783
0 | 0.25 | BK7 | 0.2491691582457
0 | 0.2499991927943 |  | 0.1552731950841
0 | 0 |  | 8.913407958194e-06
""",
    ),
}

# Numbers that are 0 or 1 for all of these lenses, as the program writes them.
_IDLE = """  FIMP
  HIDE 0 0 0 0 0 0 0 0 0 0
  MIRR 2 0"""


def zemax_text(name: str) -> str:
    """The lens as a sequential Zemax file of about version 16."""
    head, rows = ZEMAX[name]
    *before, waves = head.strip().splitlines()
    lines = ["VERS 160608 48 100027", "MODE SEQ", "NAME ", "PFIL 0 0 0", "UNIT MM X W X CM MR CPMM", *before]
    wavelengths = waves.split()[1:]
    # All 24 wavelength slots are written, whether they are used or not.
    lines += [f"WAVM {i + 1} {(wavelengths + 24 * ['0.55'])[i]} 1" for i in range(24)]
    for number, row in enumerate(rows.strip().splitlines()):
        curvature, distance, glass, rim, *rest = [word.strip() for word in row.split("|")]
        extras = [word.strip() for word in "".join(rest).split(";") if word.strip()]
        lines += [f"SURF {number}", *(f"  {extra}" for extra in extras if extra == "STOP")]
        kind = next((extra for extra in extras if extra.startswith("TYPE")), "TYPE STANDARD")
        lines += [f"  {kind}", f'  CURV {curvature} 0 0 0 0 ""', _IDLE]
        lines += [f"  {extra}" for extra in extras if extra != "STOP" and extra != kind]
        lines.append(f"  DISZ {'INFINITY' if distance == 'inf' else distance}")
        if glass:
            glass_name, *index = glass.split()
            n_d, v_d = index or ("1.5", "40")
            lines.append(f"  GLAS {glass_name} 0 0 {n_d} {v_d} 0 0 0 0 0 0")
        lines += [f'  DIAM {rim} 0 0 0 1 ""', f'  MEMA {rim} 0 0 0 1 ""']
    return "\n".join([*lines, "BLNK ", "TOL TOFF 0 0 0 0 0 0 0 0 0", "MNUM 1 1", ""])


CODE_V = {
    # Catalogue data of an achromat, 25 mm wide, 35 mm of focal length, whose last face is an asphere in plastic.
    "achromat-25x35.seq": """RDM;LEN "VERSION: 11.2"
TITLE 'Aspheric achromat 25 x 35'
EPD 25.0
DIM M
WL 656.3 587.6 486.1
REF 2
WTW 1 1 1
XAN 0 0
YAN 0 2
SO 0.0 0.1e14
S 23.5 9.0 SLAL8_OHARA
  STO
  SLB "front"
S -36.7 2.5 STIH53_OHARA
S 0.0 0.08 517000.520000
S -323.006393602994 28.077783387
  ASP
  K 0
  CUF 0
  A 0.138925111836e-4; B -0.208175206307e-7; C 0; D 0
SI 0 0
GO
""",
    # Catalogue data of a tiny achromat of f/1.5.
    "achromat-1.5mm.seq": """RDM;LEN
TITLE 'Achromat of 1.5 mm'
EPD 1.0
DIM M
WL 587.6
XAN 0
YAN 0
SO 0 1e13
S 0.8 0.5 NPSK53A_SCHOTT
  STO; CIR 0.25
S -0.8 0.5 NLASF9_SCHOTT
S -4.5 0.9176749924408083
  CIR 0.25
  PIM
SI 0 0
GO
""",
    "asphere-without-power.seq": """RDM N
LEN
TITLE 'An asphere that is flat in its middle'
EPD 2.0
DIM M
WL 587.6
XAN 0 0
YAN 0 1
SO 0 1.0E+10
S 0 1. 500.700
  CIR EDG 0.55
  STO
  ASP
  K 0
  A -0.1
  B 0.1
S 0 2.
  CIR EDG 0.55
SI 0 0
GO
""",
    # The prescription whose listing is in ../truth/code_v_listing.py, by curvatures.
    "double-gauss-100mm.seq": """RDM N;LEN "VERSION: 10.7"
TITLE 'Double Gauss f/2'
EPD 50
DIM M
WL 656.3 587.6 486.1
REF 2
WTW 1 1 1
XAN 0 0 0
YAN 0 10.0000000023 14.0000000032
VUY 0 0.2 0.4
VLY 0 0.25 0.4
SO 0 993938392063.0
S 0.01779284094091543 8.75 NSSK2_SCHOTT
  CCY 0
S 0.006566600536925569 0.5
S 0.02653743294670983 12.5 NSK2_SCHOTT
S 0 3.8 F5_SCHOTT
S 0.04126892878570084 16.36944492653564
  CCY 0; THC 0
S 0 13.74795696388906
  STO
S -0.03523942654429074 3.8 F5_SCHOTT
S 0 11.0 NSK16_SCHOTT
S -0.02636750828657709 0.5
S 0.005636604951748545 7.0 NSK16_SCHOTT
S -0.0125926458590576 61.4875364179821
  PIM
SI 0 -0.4002686453541377
DER VAL I1 -0.6370618627459224e-5
GO
""",
}

NAMES = (*ZEMAX, *CODE_V)


def write_foreign_lens(name: str, folder: Path) -> Path:
    path = folder / name
    if name in CODE_V:
        path.write_text(CODE_V[name])
    else:
        path.write_bytes(zemax_text(name).encode("utf-16" if name == "moulded-asphere.zmx" else "latin-1"))
    return path
