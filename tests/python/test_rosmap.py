"""Maps are read as map_server reads them; hand-computed values for every mode."""

import numpy as np
import pytest
from aisle_tools import rosmap
from aisle_tools.errors import UserError
from PIL import Image

YAML = {
    "image": "m.png",
    "resolution": 0.5,
    "origin": "[1.0, 2.0, 0.0]",
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.25,
}

# Grey values with p = (255 - v) / 255:  255: 0.000  205: 0.196  192: 0.247  128: 0.498  90: 0.647  89: 0.651  0: 1.000
GREYS = [255, 205, 192, 128, 90, 89, 0]


def write(folder, pixels, pixel_type="L", drop=(), **keys):
    Image.fromarray(np.array(pixels, dtype=np.uint8), pixel_type).save(folder / "m.png") if pixels is not None else None
    path = folder / "m.yaml"
    values = {**YAML, **keys}
    path.write_text("".join(f"{k}: {v}\n" for k, v in values.items() if k not in drop))
    return path


def values_of(path):
    settings = rosmap.read_settings(path)
    return rosmap.cell_values(*rosmap.read_channels(settings.image), settings).tolist()


def test_trinary_splits_by_both_thresholds(tmp_path):
    assert values_of(write(tmp_path, [GREYS])) == [[0, 0, 0, -1, -1, 100, 100]]


def test_trinary_is_the_default_and_can_be_named(tmp_path):
    assert values_of(write(tmp_path, [GREYS], mode="Trinary")) == values_of(write(tmp_path, [GREYS]))


def test_negate_makes_white_occupied(tmp_path):
    # p = v / 255: 1.0, 0.80, 0.75, 0.50, 0.353, 0.349, 0
    assert values_of(write(tmp_path, [GREYS], negate=1)) == [[100, 100, 100, -1, -1, -1, 0]]


def test_scale_interpolates_between_the_thresholds(tmp_path):
    # 128: (0.49804 - 0.25) / 0.4 = 62.01 %; 90: (0.64706 - 0.25) / 0.4 = 99.26 %
    path = write(tmp_path, [GREYS], mode="scale")
    assert values_of(path) == [[0, 0, 0, 62, 99, 100, 100]]


def test_raw_takes_the_grey_value_whatever_negate_says(tmp_path):
    for negate in (0, 1):
        path = write(tmp_path, [[0, 1, 50, 100, 101, 255]], negate=negate, mode="raw")
        assert values_of(path) == [[0, 1, 50, 100, -1, -1]]


def test_alpha_is_a_fourth_channel_in_trinary_and_unknown_in_scale(tmp_path):
    # opaque white: shade 1; transparent white: (3 + 0) / 4 = 0.75, p = 0.25: not below free_thresh
    rgba = [[[255, 255, 255, 255], [255, 255, 255, 0], [0, 0, 0, 0]]]
    path = write(tmp_path, rgba, "RGBA")
    assert values_of(path) == [[0, -1, 100]]
    path.write_text(path.read_text() + "mode: scale\n")
    assert values_of(path) == [[0, -1, -1]]


def test_grey_and_alpha_counts_grey_three_times(tmp_path):
    Image.fromarray(np.array([[[255, 0]]], dtype=np.uint8), "LA").save(tmp_path / "m.png")
    assert values_of(write(tmp_path, None)) == [[-1]]  # (3 + 0) / 4, as with RGBA


def test_colours_are_averaged(tmp_path):
    # (255 + 255 + 0) / 3 = 170: p = 0.333; (255 + 0 + 0) / 3 = 85: p = 0.667
    assert values_of(write(tmp_path, [[[255, 255, 0], [255, 0, 0]]], "RGB")) == [[-1, 100]]


def test_sixteen_bit_and_bilevel_images(tmp_path):
    path = write(tmp_path, [[0]])
    Image.fromarray(np.array([[65535, 205 * 257, 0]], dtype=np.uint16)).save(tmp_path / "m.png")
    assert values_of(path) == [[0, 0, 100]]
    Image.fromarray(np.array([[True, False]])).save(tmp_path / "m.png")
    assert values_of(path) == [[0, 100]]


def test_pgm_with_comment_and_other_maximum(tmp_path):
    path = write(tmp_path, [[0]], image="m.pgm")
    (tmp_path / "m.pgm").write_bytes(b"P5\n# saved by a map_saver\n2 1\n100\n" + bytes([100, 0]))
    assert values_of(path) == [[0, 100]]


def test_first_image_row_is_the_top_and_unknown_is_occupied(tmp_path):
    world = rosmap.read_world(write(tmp_path, [[255, 128], [0, 255]]))
    assert world.grid.occupied.tolist() == [[True, False], [False, True]]  # bottom row first
    assert world.bounds == (1.0, 2.0, 2.0, 3.0)
    assert world.grid.is_occupied(1.25, 2.25) and not world.grid.is_occupied(1.25, 2.75)
    assert world.grid.is_occupied(0.9, 2.25)  # outside


def test_strict_free_turns_grey_205_into_occupied(tmp_path):
    path = write(tmp_path, [[255, 205]])
    assert rosmap.read_world(path).grid.occupied.tolist() == [[False, False]]
    assert rosmap.read_world(path, strict_free=True).grid.occupied.tolist() == [[False, True]]


def test_strict_free_never_loosens_a_threshold(tmp_path):
    path = write(tmp_path, [[255, 230]], free_thresh=0.05)  # 230: p = 0.098
    assert rosmap.read_world(path, strict_free=True).grid.occupied.tolist() == [[False, True]]


def test_resolution_is_what_travels_as_float(tmp_path):
    world = rosmap.read_world(write(tmp_path, [[255] * 1000], resolution=0.03))
    assert world.grid.resolution == float(np.float32(0.03))
    assert world.bounds[2] == 1.0 + 1000 * float(np.float32(0.03))


@pytest.mark.parametrize(
    ("keys", "needle"),
    [
        ({"image": "gone.png"}, "image 'gone.png' not found"),
        ({"image": "''"}, "image must be a file name"),
        ({"resolution": 0.0}, "resolution must be above 0"),
        ({"resolution": -0.05}, "resolution must be above 0"),
        ({"resolution": "fine"}, "resolution must be a number"),
        ({"resolution": ".nan"}, "resolution must be a number"),
        ({"origin": "[0, 0, 0.1]"}, "origin yaw 0.1 is not supported"),
        ({"origin": "[0, 0]"}, "origin must be [x, y, yaw]"),
        ({"negate": 2}, "negate must be 0 or 1"),
        ({"free_thresh": 0.7}, "0 <= free_thresh <= occupied_thresh <= 1"),
        ({"mode": "binary"}, "mode must be one of trinary, scale, raw"),
        ({"ocupied_thresh": 0.6}, "unknown key 'ocupied_thresh', is 'occupied_thresh' meant?"),
    ],
)
def test_errors_name_the_file_and_the_key(tmp_path, keys, needle):
    path = write(tmp_path, [[255]], **keys)
    with pytest.raises(UserError) as e:
        rosmap.read_world(path)
    assert needle in str(e.value) and "m.yaml" in str(e.value) and "\n" not in str(e.value)


@pytest.mark.parametrize("key", rosmap.REQUIRED)
def test_each_missing_key_is_named(tmp_path, key):
    with pytest.raises(UserError, match=f"key '{key}' is missing"):
        rosmap.read_world(write(tmp_path, [[255]], drop=(key,)))


def test_misspelt_key_is_pointed_out(tmp_path):
    path = write(tmp_path, [[255]], drop=("resolution",), resolutoin=0.05)
    with pytest.raises(UserError, match="'resolution' is missing \\(is 'resolutoin' meant"):
        rosmap.read_world(path)


def test_foreign_keys_are_ignored_with_a_word(tmp_path, capsys):
    rosmap.read_world(write(tmp_path, [[255]], image_type="x"))
    assert "image_type" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["image: [", "just words", "- a\n- b\n"])
def test_what_is_no_map_yaml_is_refused(tmp_path, text):
    path = tmp_path / "m.yaml"
    path.write_text(text)
    with pytest.raises(UserError, match="YAML"):
        rosmap.read_settings(path)


def test_broken_image_is_refused(tmp_path):
    path = write(tmp_path, [[255]])
    (tmp_path / "m.png").write_bytes((tmp_path / "m.png").read_bytes()[:40])
    with pytest.raises(UserError, match="image"):
        rosmap.read_world(path)
    (tmp_path / "m.png").write_text("hello")
    with pytest.raises(UserError, match="not an image"):
        rosmap.read_world(path)


def test_map_over_the_limit_says_which_and_how_many(tmp_path):
    path = write(tmp_path, np.full((3, 4), 255))
    rosmap.read_world(path, max_cells=12)
    with pytest.raises(UserError, match=r"4 x 3 = 12 cells is over the limit 'cells' = 11: 12 needed"):
        rosmap.read_world(path, max_cells=11)


def test_size_is_judged_before_the_pixels_are_read(tmp_path):
    path = write(tmp_path, [[255]], image="m.pgm")
    (tmp_path / "m.pgm").write_bytes(b"P5 60000 60000 255\n")  # 3.6e9 cells, no pixels
    with pytest.raises(UserError, match="3600000000 cells is over the limit 'cells' = 4194304"):
        rosmap.read_world(path)
    (tmp_path / "m.pgm").write_bytes(b"P5 70000 1 255\n")
    with pytest.raises(UserError, match="a side may have at most 65535 cells"):
        rosmap.read_world(path)


def test_map_without_a_free_cell_is_refused(tmp_path):
    with pytest.raises(UserError, match="no cell is free"):
        rosmap.read_world(write(tmp_path, [[0, 128]]))


def test_every_map_of_the_test_data_can_be_read(data):
    for path in sorted((data / "ros_maps").glob("*.yaml")):
        world = rosmap.read_world(path, strict_free=True)
        assert 0.0 < world.grid.occupied.mean() < 1.0
