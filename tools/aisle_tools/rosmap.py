"""ROS map_server maps: YAML beside an image, read as nav2's map_server reads them.

Occupancy of a pixel: shade = mean of its channels in 0..1, p = shade if negate else 1 - shade. Cell values:
trinary (alpha counts as a fourth channel): 100 if p > occupied_thresh, 0 if p < free_thresh, else unknown;
scale: the same with 0..100 in between, unknown where the pixel is not opaque; raw: the grey value if 0..100, else unknown
(negate and thresholds play no part). On the wire a cell is free if its value is 0 and occupied otherwise.
"""

from __future__ import annotations

import difflib
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from PIL import Image, UnidentifiedImageError

from aisle_tools.errors import UserError
from aisle_tools.world import Grid, World, float32

CELLS_DEFAULT = 4_194_304  # limits.cells of aisled
CELLS_MAX = 16_777_216
SIDE_MAX = 65_535
STRICT_FREE = 0.196  # just below p of grey 205, the usual "unknown"
UNKNOWN = -1

REQUIRED = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")
KEYS = (*REQUIRED, "mode")
MODES = ("trinary", "scale", "raw")


@dataclass
class MapSettings:
    image: Path
    resolution: float
    origin: tuple[float, float]
    negate: bool
    occupied_thresh: float
    free_thresh: float
    mode: str


def read_settings(path: Path) -> MapSettings:
    data = _load_yaml(path)
    _check_keys(path, data)
    resolution = _number(path, data, "resolution")
    if resolution <= 0.0:
        raise UserError(f"{path}: resolution must be above 0 m per cell, not {resolution:g}")
    occupied, free = _number(path, data, "occupied_thresh"), _number(path, data, "free_thresh")
    if not 0.0 <= free <= occupied <= 1.0:
        raise UserError(f"{path}: need 0 <= free_thresh <= occupied_thresh <= 1, not {free:g} and {occupied:g}")
    mode = str(data.get("mode", "trinary")).lower()
    if mode not in MODES:
        raise UserError(f"{path}: mode must be one of {', '.join(MODES)}, not '{data['mode']}'")
    return MapSettings(_image_path(path, data), resolution, _origin(path, data), _negate(path, data), occupied, free, mode)


def _load_yaml(path: Path) -> dict:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    except UnicodeDecodeError:
        raise UserError(f"{path}: not a text file; give the map's .yaml, not its image") from None
    try:
        data = yaml.safe_load(text)
    except yaml.YAMLError as e:
        mark = getattr(e, "problem_mark", None)
        where = f":{mark.line + 1}" if mark is not None else ""
        raise UserError(f"{path}{where}: not valid YAML: {getattr(e, 'problem', None) or e}") from None
    if not isinstance(data, dict):
        raise UserError(f"{path}: not a map_server YAML (no 'image:', 'resolution:' ...)")
    return data


def _check_keys(path: Path, data: dict) -> None:
    for key in REQUIRED:
        if key not in data:
            near = difflib.get_close_matches(key, [str(k) for k in data if k not in KEYS], 1)
            hint = f" (is '{near[0]}' meant?)" if near else ""
            raise UserError(f"{path}: key '{key}' is missing{hint}; a map needs {', '.join(REQUIRED)}")
    for key in data:
        if key in KEYS:
            continue
        near = difflib.get_close_matches(str(key), KEYS, 1, 0.8)
        if near:
            raise UserError(f"{path}: unknown key '{key}', is '{near[0]}' meant?")
        print(f"aisle: {path}: key '{key}' is not read by map_server, ignored", file=sys.stderr)


def _number(path: Path, data: dict, key: str) -> float:
    value = data[key]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise UserError(f"{path}: {key} must be a number, not '{value}'")
    return float(value)


def _origin(path: Path, data: dict) -> tuple[float, float]:
    value = data["origin"]
    numbers = isinstance(value, list) and all(isinstance(v, (int, float)) and math.isfinite(v) for v in value)
    if not numbers or len(value) != 3:
        raise UserError(f"{path}: origin must be [x, y, yaw], not {value}")
    if value[2] != 0:
        raise UserError(f"{path}: origin yaw {value[2]:g} is not supported, only 0: rotate the image instead")
    return float(value[0]), float(value[1])


def _negate(path: Path, data: dict) -> bool:
    if data["negate"] not in (0, 1, True, False):
        raise UserError(f"{path}: negate must be 0 or 1, not '{data['negate']}'")
    return bool(data["negate"])


def _image_path(path: Path, data: dict) -> Path:
    if not isinstance(data["image"], str) or not data["image"]:
        raise UserError(f"{path}: image must be a file name, not '{data['image']}'")
    image = path.parent / Path(data["image"]).expanduser()
    if not image.is_file():
        raise UserError(f"{path}: image '{data['image']}' not found (looked for {image})")
    return image


def check_size(path: Path, width: int, height: int, max_cells: int) -> None:
    if max(width, height) > SIDE_MAX:
        raise UserError(f"{path}: {width} x {height} cells: a side may have at most {SIDE_MAX} cells")
    cells = width * height
    if cells <= max_cells:
        return
    if cells > CELLS_MAX:
        hint = f"no aisled takes more than {CELLS_MAX}; use a coarser resolution or crop the map"
    else:
        hint = f"set 'cells' in aisled's limits to at least {cells} and give --max-cells {cells}"
    raise UserError(
        f"{path}: {width} x {height} = {cells} cells is over the limit 'cells' = {max_cells}: {cells} needed; {hint}"
    )


def read_channels(image: Path, max_cells: int = CELLS_MAX) -> tuple[np.ndarray, np.ndarray | None]:
    """(colour [h, w, c], alpha [h, w] or None), both 0..1, first row on top."""
    Image.MAX_IMAGE_PIXELS = None  # check_size() is the judge
    try:
        with Image.open(image) as picture:
            check_size(image, picture.width, picture.height, max_cells)
            return _channels(picture)
    except UnidentifiedImageError:
        raise UserError(f"{image}: not an image that can be read (PGM and PNG are)") from None
    except (OSError, ValueError, SyntaxError) as e:
        raise UserError(f"{image}: broken image: {e}") from None


def _channels(picture: Image.Image) -> tuple[np.ndarray, np.ndarray | None]:
    if picture.mode.startswith("I"):  # 16 bit
        return np.asarray(picture, dtype=np.float64)[:, :, None] / 65535.0, None
    if picture.mode in ("P", "PA") or "transparency" in picture.info:
        picture = picture.convert("RGBA")
    elif picture.mode not in ("L", "LA", "RGB", "RGBA"):
        picture = picture.convert("L")
    data = np.asarray(picture, dtype=np.float64) / 255.0
    if data.ndim == 2:
        data = data[:, :, None]
    if picture.mode in ("LA", "RGBA"):
        return data[:, :, :-1], data[:, :, -1]
    return data, None


def cell_values(colour: np.ndarray, alpha: np.ndarray | None, settings: MapSettings) -> np.ndarray:
    """map_server's value of each pixel: 0 free .. 100 occupied, -1 unknown; rows as in the image."""
    if settings.mode == "trinary" and alpha is not None:
        colour = np.repeat(colour, 3, axis=2) if colour.shape[2] == 1 else colour
        colour = np.concatenate([colour, alpha[:, :, None]], axis=2)
    shade = colour.mean(axis=2)
    if settings.mode == "raw":
        grey = np.floor(shade * 255.0 + 0.5)
        return np.where(grey <= 100, grey, UNKNOWN).astype(np.int16)
    p = shade if settings.negate else 1.0 - shade
    values = np.full(p.shape, UNKNOWN, dtype=np.int16)
    if settings.mode == "scale":
        span = settings.occupied_thresh - settings.free_thresh
        values = np.rint((p - settings.free_thresh) / span * 100.0 if span > 0.0 else 0.0 * p).astype(np.int16)
    values[p < settings.free_thresh] = 0
    values[p > settings.occupied_thresh] = 100
    if settings.mode == "scale" and alpha is not None:
        values[alpha < 1.0] = UNKNOWN
    return values


def read_world(path: Path, strict_free: bool = False, max_cells: int = CELLS_DEFAULT) -> World:
    settings = read_settings(path)
    if strict_free:
        settings.free_thresh = min(settings.free_thresh, STRICT_FREE)
    colour, alpha = read_channels(settings.image, max_cells)
    free = cell_values(colour, alpha, settings)[::-1] == 0
    grid = Grid(settings.origin[0], settings.origin[1], float32(settings.resolution), ~free)
    if not free.any():
        raise UserError(f"{path}: no cell is free; check negate and the thresholds against the image")
    return World(path.stem, grid.bounds, [], grid, grid.resolution)
