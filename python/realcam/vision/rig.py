"""Rigs of cameras that are fixed to one another: stereo pairs, camera rings, the cameras of a vehicle."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Camera, InputError, RenderSettings, Scene, Sensor
from ..calibration import Calibration
from ..calibration.transforms import quaternion, turned
from ..files import write_whole
from ..image import Image
from ..pickling import PickledByFields
from ..raw_image import RawImage
from ..settings import settings_of
from ..shot import Shot
from .calibrated_rig import cameras_in_rig
from .camera_json import camera_json
from .colmap import save_colmap_of_rig
from .conventions import relative_pose
from .fit import CameraModelFit

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .._core import _SettingsKwargs

Array = NDArray[np.float64]
Matrix = tuple[tuple[float, ...], ...]

UNMOVED: Matrix = tuple(tuple(row) for row in np.eye(4).tolist())


@dataclass(frozen=True)
class RigCamera(PickledByFields):
    """A camera of a rig, with its sensor and filter.

    camera: posed in the frame of the rig. sensor: makes raw images from the film's exposure; None: no raw images.
    spectral_filter: filter on that sensor, pairs of a wavelength in nm and a transmission from 0 to 1, interpolated
    linearly and 0 outside; (): no filter.

    Raises InputError.
    """

    camera: Camera
    sensor: Sensor | None = None
    spectral_filter: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.camera, Camera):
            raise InputError(f"a camera of a rig is a realcam.Camera or a RigCamera; it is {self.camera!r:.60}")
        if self.sensor is not None and not isinstance(self.sensor, Sensor):
            raise InputError(f"the sensor of a rig's camera is a realcam.Sensor or None; it is {self.sensor!r:.60}")
        try:
            table = tuple((float(nm), float(share)) for nm, share in self.spectral_filter)
        except (TypeError, ValueError):
            raise InputError("spectral_filter must be pairs of a wavelength in nm and a transmission") from None
        object.__setattr__(self, "spectral_filter", table)
        if table and self.sensor is None:
            raise InputError("spectral_filter: the camera has no sensor for which light could be filtered")
        self.filtered_sensor  # noqa: B018 - raises InputError for an invalid filter

    def __repr__(self) -> str:
        with_filter = " with a filter" if self.spectral_filter else ""
        sensor = f" on {self.sensor.name!r:.30}{with_filter}" if self.sensor else ""
        return f"<realcam.RigCamera {self.camera!r:.60}{sensor}>"

    @property
    def filtered_sensor(self) -> Sensor | None:
        """The sensor with the filter multiplied into its cover glass; None: no sensor."""
        if self.sensor is None or not self.spectral_filter:
            return self.sensor
        tables = [np.array(table) for table in (self.spectral_filter, self.sensor.cover_glass) if len(table)]
        knots = np.unique(np.concatenate([table[:, 0] for table in tables]))
        if len(tables) > 1:  # the product of two linear pieces is not linear: resample at 1 nm
            knots = np.unique(np.concatenate([knots, np.arange(knots[0], knots[-1])]))
        product = np.prod([np.interp(knots, table[:, 0], table[:, 1], left=0, right=0) for table in tables], axis=0)
        return self.sensor.replace(cover_glass=list(zip(knots.tolist(), product.tolist(), strict=True)))

    @property
    def filter_factor(self) -> float:
        """Ratio of the sensor's responses to white light (D65) with and without the filter, 0 to 1.

        It is that of the channel with the largest response, and 1 without a sensor. Raises InputError.
        """
        if self.sensor is None or self.filtered_sensor is None:
            return 1.0
        with_filter, without = (
            each.electrons_per_um2().sum(axis=1).max() for each in (self.filtered_sensor, self.sensor)
        )
        return float(with_filter / without)


@dataclass(frozen=True)
class Rig(PickledByFields):
    """Cameras that are fixed to one another, by their names.

    rig = rc.Rig.stereo(camera, baseline_m=0.12)
    images = rig.moved(scene_from_rig).render(scene)  # {"left": ..., "right": ...}

    members: cameras by name, Camera or RigCamera, posed in the frame of the rig. scene_from_rig: (4, 4), pose of the
    rig in the scene: a rotation and a translation in metres. times_s: for a rig that moves while shutters are open, the
    K times in seconds at which scene_from_rig, then (K, 4, 4), gives the pose; (): the rig does not move.

    Raises InputError.
    """

    members: Mapping[str, RigCamera]
    scene_from_rig: Any = UNMOVED
    times_s: tuple[float, ...] = field(default=())

    def __post_init__(self) -> None:
        if not isinstance(self.members, Mapping) or not self.members:
            raise InputError("members must be a mapping of names to cameras, with one camera at least")
        members = {}
        for name, member in self.members.items():
            if not isinstance(name, str) or not name:
                raise InputError(f"a camera of a rig has a text as its name; it is {name!r:.60}")
            members[name] = member if isinstance(member, RigCamera) else RigCamera(member)
        object.__setattr__(self, "members", members)
        object.__setattr__(self, "times_s", tuple(float(time_s) for time_s in self.times_s))
        poses = _rigid(self.scene_from_rig, len(self.times_s))
        object.__setattr__(self, "scene_from_rig", _nested(poses))
        if self.times_s and any(member.camera.motion for member in members.values()):
            raise InputError("the cameras of a moving rig must not move within it; one of them has a motion")
        self.cameras  # noqa: B018 - raises InputError for times that are out of order

    def __hash__(self) -> int:
        return hash((tuple(self.members.items()), self.scene_from_rig, self.times_s))

    def __repr__(self) -> str:
        return f"<realcam.Rig of {len(self.members)} cameras: {', '.join(self.members):.60}>"

    @classmethod
    def stereo(cls, camera: Camera, *, baseline_m: float, toe_in_deg: float = 0.0) -> Rig:
        """Returns a stereo rig of two copies of a camera, named "left" and "right" after the sides of its position.

        baseline_m: distance between the film centres. toe_in_deg: rotation of each camera towards the other, about its
        film centre. The frame of the rig is the camera's: x right, y up, z backward, origin at the film centre.

        Raises InputError.
        """
        if not 0 < baseline_m < np.inf:
            raise InputError(f"baseline_m must be a positive number of metres, not {baseline_m!r:.20}")
        if camera.motion:
            raise InputError("a stereo rig needs a camera without motion; moved() gives the rig a motion")
        toe_in = np.radians(toe_in_deg)
        members = {}
        for name, side in (("left", -1.0), ("right", 1.0)):
            x = 0.5 * side * baseline_m
            look_at = (x - side * np.sin(toe_in), 0.0, -np.cos(toe_in))
            members[name] = RigCamera(camera.replace(position=(x, 0, 0), look_at=look_at, up=(0, 1, 0)))
        return cls(members, pose_of(camera))

    @classmethod
    def of_calibrations(cls, calibrations: Mapping[str, Calibration], **settings: Any) -> Rig:
        """Returns a rig of calibrated cameras, posed by the extrinsics of their calibrations.

        rig = rc.Rig.of_calibrations(rc.Calibration.load_all("camchain.yaml"), focus_m=3)

        calibrations: by the names of the cameras. settings: arguments of Calibration.camera, for all cameras, such as
        lens, film_width_mm, focus_m and exposure_time_s. The frame of the rig is that of the first camera: x right,
        y up, z backward, origin at its centre of projection; the rig stands at the origin of the scene, see moved.

        Raises InputError, also if the calibrations do not state their relative poses.
        """
        return cls({name: RigCamera(camera) for name, camera in cameras_in_rig(calibrations, settings).items()})

    @property
    def cameras(self) -> dict[str, Camera]:
        """The cameras by name, posed in the scene."""
        return {name: _placed(member.camera, self._poses, self.times_s) for name, member in self.members.items()}

    @property
    def _poses(self) -> Array:
        poses: Array = np.array(self.scene_from_rig).reshape(-1, 4, 4)
        return poses

    def moved(self, scene_from_rig: ArrayLike, times_s: Sequence[float] = ()) -> Rig:
        """Returns the rig in another pose or motion. scene_from_rig, times_s: as for Rig. Raises InputError."""
        return replace(self, scene_from_rig=scene_from_rig, times_s=tuple(times_s))

    def metered(self, scene: Scene, *, device: str = "auto") -> Rig:
        """Returns the rig with exposure times by which the average of each camera's picture is middle grey.

        Raises what render raises.
        """
        times = {name: camera.metered(scene, device=device).exposure_time_s for name, camera in self.cameras.items()}
        members = {
            name: replace(member, camera=member.camera.replace(exposure_time_s=times[name]))
            for name, member in self.members.items()
        }
        return replace(self, members=members)

    def shots(
        self, scene: Scene, settings: RenderSettings | None = None, **changes: Unpack[_SettingsKwargs]
    ) -> dict[str, Shot]:
        """Returns one shot per camera, by name, for example for rc.Job. settings, changes: as for rc.render.

        Each shot has its own seed, because a program that matches pictures would take identical noise for detail of the
        scene. Raises InputError.
        """
        rig_settings = settings_of(settings, changes)
        return {
            name: Shot(scene, camera, rig_settings.with_(seed=(rig_settings.seed + number) % 2**32))
            for number, (name, camera) in enumerate(self.cameras.items())
        }

    def render(
        self,
        scene: Scene,
        settings: RenderSettings | None = None,
        *,
        device: str = "auto",
        **changes: Unpack[_SettingsKwargs],
    ) -> dict[str, Image]:
        """Renders the pictures of all cameras, as rc.render does, and returns them by name.

        The scene is prepared once: its acceleration structure serves all cameras, and later pictures of the same scene.
        Raises what rc.render raises.
        """
        return {name: shot.render(device=device) for name, shot in self.shots(scene, settings, **changes).items()}

    def expose(self, images: Mapping[str, Image], *, seed: int = 0) -> dict[str, RawImage]:
        """Returns the raw images of rendered pictures by name, for the cameras that have a sensor.

        They are those of Sensor.expose, with the cameras' filters. A filter does not change the gain that the camera's
        ISO sets, so the ISO of the raw image is the camera's times filter_factor. seed: of the noise. Each sensor has
        its own fixed-pattern noise. Raises InputError.
        """
        raws = {}
        for number, (name, member) in enumerate(self.members.items()):
            sensor = member.filtered_sensor
            if name in images and sensor is not None:
                iso = images[name].camera.iso * member.filter_factor
                raws[name] = sensor.expose(images[name], iso=iso, seed=seed, serial=number)
        return raws

    def relative_pose(self, of: str, seen_from: str) -> tuple[Array, Array]:
        """Returns (R, t): R @ point + t transforms points from the frame of `seen_from` to the frame of `of`.

        R is (3, 3) and t is (3), in metres. Both frames have the axes x right, y down, z forward, and their origin at
        the centre of the entrance pupil. relative_pose("right", "left") gives cv2.stereoCalibrate's R and T.

        Raises InputError.
        """
        pose, from_pose = (self._member(name).camera.world_to_camera for name in (of, seen_from))
        return relative_pose(pose, from_pose)

    def _member(self, name: str) -> RigCamera:
        if name not in self.members:
            raise InputError(f"the rig has no camera {name!r:.40}; expected one of {', '.join(self.members):.200}")
        return self.members[name]

    def calibration(self, fits: Iterable[CameraModelFit] = ()) -> dict[str, Any]:
        """Returns the intrinsics and poses of all cameras as values for json.dump (docs/rigs.md).

        fits: results of rc.fit_camera_model for rig.cameras. Raises InputError, also for a moving rig.
        """
        if self.times_s:
            raise InputError("a moving rig has no single pose; moved(matrix) stops it")
        fits = list(fits)
        cameras = {}
        for name, camera in self.cameras.items():
            rotation, translation = self.members[name].camera.world_to_camera
            cameras[name] = camera_json(camera, [fit for fit in fits if fit.camera == camera]) | {
                "rig_to_camera": {"rotation": rotation.tolist(), "translation_m": translation.tolist()}
            }
        return {"rig_to_world": [list(row) for row in self.scene_from_rig], "cameras": cameras}

    def save_calibration(self, path: str | os.PathLike[str], fits: Iterable[CameraModelFit] = ()) -> None:
        """Writes calibration() as JSON. Raises InputError, ImageFileError."""
        write_whole(path, (json.dumps(self.calibration(fits), indent=1) + "\n").encode())

    def save_colmap(
        self, folder: str | os.PathLike[str], poses: Mapping[str, ArrayLike], model: str = "opencv5"
    ) -> None:
        """Writes a COLMAP text model with rig and frames, for pictures that the rig takes at several poses.

        poses: scene_from_rig by image name; each camera's images lie in a folder with the camera's name. model: the
        camera model to fit to each camera. Raises InputError, ImageFileError.
        """
        save_colmap_of_rig(folder, {name: self.moved(pose).cameras for name, pose in poses.items()}, model)

    def save_colmap_rig(self, path: str | os.PathLike[str]) -> None:
        """Writes COLMAP's rig_config.json, for pictures in one folder per camera, named after the camera.

        The first camera is the reference of the other poses. Raises InputError, ImageFileError.
        """
        first = next(iter(self.members))
        cameras: list[dict[str, Any]] = [{"image_prefix": f"{first}/", "ref_sensor": True}]
        for name in list(self.members)[1:]:
            rotation, translation = self.relative_pose(name, first)
            cameras.append(
                {
                    "image_prefix": f"{name}/",
                    "cam_from_rig_rotation": quaternion(turned(rotation, translation)),
                    "cam_from_rig_translation": translation.tolist(),
                }
            )
        write_whole(path, (json.dumps([{"cameras": cameras}], indent=1) + "\n").encode())


def _rigid(matrices: ArrayLike, times: int) -> Array:
    """Returns matrices as an array, one for each time or a single one. Raises InputError unless they are rigid."""
    try:
        poses: Array = np.array(matrices, dtype=float)
    except (TypeError, ValueError):
        poses = np.zeros(0)
    if poses.shape != ((times, 4, 4) if times else (4, 4)) or not np.isfinite(poses).all():
        expected = f"{times} matrices, one for each of times_s," if times else "a (4, 4) matrix"
        raise InputError(f"scene_from_rig must be {expected} of finite numbers")
    rotations = np.clip(poses[..., :3, :3], -2, 2)  # products of larger elements, which no rotation has, might overflow
    # The tolerance admits rotations written with seven digits.
    is_orthogonal = np.allclose(rotations @ np.swapaxes(rotations, -1, -2), np.eye(3), atol=1e-6)
    is_rotation = is_orthogonal and (np.linalg.det(rotations) > 0).all()
    if not is_rotation or not np.allclose(poses[..., 3, :], (0, 0, 0, 1), rtol=0, atol=1e-12):
        raise InputError("scene_from_rig must only rotate and move: a rig is neither scaled nor mirrored")
    return poses


def _nested(poses: Array) -> Any:
    """Returns the array as nested tuples, which can be compared and hashed."""
    return tuple(map(_nested, poses)) if poses.ndim else float(poses)


def pose_of(camera: Camera) -> Array:
    """Returns the (4, 4) matrix from a camera's frame to the scene.

    The frame has the axes x right, y up, z backward, and its origin at the film centre.
    """
    pose = np.eye(4)
    backward = np.subtract(camera.position, camera.look_at)
    right = np.cross(camera.up, backward)
    pose[:3, 0] = right / np.linalg.norm(right)
    pose[:3, 2] = backward / np.linalg.norm(backward)
    pose[:3, 1] = np.cross(pose[:3, 2], pose[:3, 0])
    pose[:3, 3] = camera.position
    return pose


def _placed(camera: Camera, poses: Array, times_s: tuple[float, ...]) -> Camera:
    """Transforms a camera of the rig into the scene by the rig's poses."""

    def at(
        pose: Array, position: Sequence[float], look_at: Sequence[float], up: Sequence[float]
    ) -> tuple[tuple[float, ...], ...]:
        rotation, shift = pose[:3, :3], pose[:3, 3]
        return tuple(
            tuple(v.tolist()) for v in (rotation @ position + shift, rotation @ look_at + shift, rotation @ up)
        )

    in_rig = camera.position, camera.look_at, camera.up
    if times_s:
        motion: Any = [(time_s, *at(pose, *in_rig)) for time_s, pose in zip(times_s, poses, strict=True)]
    else:
        motion = [(time_s, *at(poses[0], *key)) for time_s, *key in camera.motion]
    position, look_at, up = at(poses[0], *in_rig)
    return camera.replace(position=position, look_at=look_at, up=up, motion=motion)
