"""A page for each effect: what it is, and a picture without and with it under one slider."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import effect_pictures
import realcam as rc
from effect_pictures import Pair
from written import is_newer, remove_others, stand_in_for, write_text

# Files that contain the text of the pages; that of rc.effects() is in the extension.
SOURCES = (Path(__file__), Path(effect_pictures.__file__), Path(rc._core.__file__))


def page_of(effect: rc.EffectInfo, pair: Pair) -> str:
    usage = f" {effect.usage}." if effect.usage else ""
    times = ""
    if effect.cpu_time:
        times = f"A picture takes {effect.cpu_time:.2f} times as long on a CPU, {effect.gpu_time:.2f} on a GPU.\n\n"
    switched, way = (f'"-{effect.name}"', "off") if effect.is_on else (f'"{effect.name}"', "on")
    return (
        f"# {title_of(effect)}\n\n{capital(effect.what)}.\n\n"
        f"```{{container}} before-after\n"
        f"![Without {title_of(effect).lower()}]({effect.name}-without.png)\n"
        f"![With {title_of(effect).lower()}]({effect.name}-with.png)\n```\n\n"
        f"{pair.what} Drag the line, or move it with the arrow keys.\n\n"
        f"It needs {effect.needs}.{usage}\n\n{times}"
        f"`effects={{{switched}}}` or `--effects={switched[1:-1]}` switches it {way}. "
        "The [planner](../docs/plan.md) decides where nobody does.\n\n"
        f"[How it is simulated, and how far to trust it](../docs/{pair.page or effect.name}.md)\n"
    )


def capital(text: str) -> str:
    return text[0].upper() + text[1:]


def title_of(effect: rc.EffectInfo) -> str:
    return capital(effect.name.replace("_", " "))


def write(folder: Path, names: Sequence[str] | None = None, *, has_pictures: bool = True) -> None:
    """Writes what is missing or older than its sources, with index.md as the first page. names: None is all effects.
    has_pictures: otherwise no picture is made, and empty ones stand where there are none."""
    folder.mkdir(parents=True, exist_ok=True)
    effects = [effect for effect in rc.effects() if names is None or effect.name in names]
    for effect in effects:
        page = folder / f"{effect.name}.md"
        made = [folder / f"{effect.name}-{suffix}.png" for suffix in ("without", "with")]
        if not has_pictures:
            stand_in_for(made)
        is_made = not has_pictures or all(is_newer(picture, effect_pictures.SOURCES) for picture in made)
        if is_made and is_newer(page, SOURCES):
            continue
        pair = effect_pictures.PAIRS[effect.name]()
        if not is_made:
            pair.save(folder, effect.name)
        page.write_text(page_of(effect, pair), encoding="utf-8")
    remove_others(folder, {"index", *(effect.name for effect in effects)})
    lines = [
        "# Effects, without and with\n",
        "Each page has a picture without and with the effect, under one slider. "
        "[The table](../docs/generated/effects.md) says what each needs and costs.\n",
        *(f"- [{title_of(effect)}]({effect.name}.md): {effect.what}" for effect in effects),
        "\n```{toctree}\n:hidden:\n",
        *(effect.name for effect in effects),
        "```\n",
    ]
    write_text(folder / "index.md", "\n".join(lines))
