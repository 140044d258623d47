import numpy as np
from numpy.typing import NDArray

from ._core import Camera, RenderSettings

def read_texture(
    path: bytes, encoded: bytes
) -> tuple[NDArray[np.uint8] | NDArray[np.float32], bool, list[float] | None] | None: ...
def read_environment(path: bytes) -> tuple[NDArray[np.float32], list[str]]: ...
def write_picture(
    path: bytes,
    exposure: NDArray[np.float32],
    depth: NDArray[np.float32],
    camera: Camera,
    settings: RenderSettings,
    spp: int,
    seed: int,
    film_tone: bool,
    layers: dict[str, NDArray[np.float32] | NDArray[np.uint32]],
    object_names: list[str],
    material_names: list[str],
    plan: str,
    denoiser: str,
) -> None: ...
def write_codes(path: bytes, codes: NDArray[np.uint8], entries: list[tuple[str, str]]) -> None: ...
def read_film(path: bytes) -> tuple[NDArray[np.float32], list[tuple[str, str]]]: ...
def check_image_path(path: bytes) -> None: ...
