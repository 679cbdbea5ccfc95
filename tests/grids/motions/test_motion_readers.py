"""Every format read back; real files where the data folder is there."""

import pickle
import threading

import numpy as np
import pytest

from grids.data_folder import data_folder
from grids.motions import find, list_shipped, read_motion
from grids.motions.intensity import velocity_and_displacement
from grids.motions.readers.base import vertical_sign
from grids.motions.write import write_motion
from grids.netcdf_lock import NETCDF_LOCK
from models.errors import InputError
from tests.grids.motions.conftest import EAST, NORTH

G = 9.80665


def real(name):
    folder = data_folder()
    if folder is None or not (folder / name).is_file():
        pytest.skip(f"{name} is not in the data folder")
    return folder / name


def test_at2_finds_the_other_components_and_cuts_to_the_shortest(files):
    motion = read_motion(files.at2_record())
    assert motion.components == {"horizontal": "000", "vertical": "UP"}
    np.testing.assert_allclose(motion.horizontal, G * files.north[:-7], atol=1e-7 * G)
    np.testing.assert_allclose(motion.vertical, G * files.up[:-7], atol=1e-7 * G)
    assert motion.time_step == 0.01
    assert any("cut to the shortest, 593" in note for note in motion.notes)


def test_at2_downward_component_is_turned(files):
    motion = read_motion(files.at2_record(down=True))
    np.testing.assert_allclose(motion.vertical, G * files.up[:-7], atol=1e-7 * G)
    assert any("DOWN flipped" in note for note in motion.notes)


def test_at2_component_other_than_the_file_named(files):
    motion = read_motion(files.at2_record(), component="090", vertical=False)
    np.testing.assert_allclose(motion.horizontal, G * files.east[:-7], atol=1e-7 * G)
    assert motion.vertical is None and "090" in motion.name


def test_at2_records_in_one_folder_are_kept_apart(files):
    first = files.at2_record()
    files.at2("RSN8_SOME_STA-V.AT2", files.east, "V")  # same station text, another record
    assert "cut to the shortest, 593" in " ".join(read_motion(first).notes)
    assert read_motion(first).components["vertical"] == "UP"


def test_at2_old_header(files):
    path = files.at2("OLD_000.AT2", files.north, "000", header="  600  0.0100  NPTS, DT")
    assert read_motion(path).horizontal.size == 600


@pytest.mark.parametrize(("kind", "resolution"), [("v2a", 0.05e-3), ("v1", 0.5e-6 * G)])
def test_three_component_text_formats(files, kind, resolution):
    motion = read_motion(getattr(files, kind)())
    np.testing.assert_allclose(motion.horizontal, G * files.north, atol=1.01 * resolution)
    np.testing.assert_allclose(motion.vertical, G * files.up, atol=1.01 * resolution)
    assert motion.time_step == pytest.approx(0.01)


@pytest.mark.parametrize(("unit", "factor"), [("m s-2", 1), ("g", G), ("cm/s2", 0.01), ("gal", 0.01), ("mm/s2", 1e-3)])
def test_netcdf_units(files, unit, factor):
    motion = read_motion(files.netcdf(units=unit))
    np.testing.assert_allclose(motion.horizontal, factor * files.north, rtol=1e-14)


def test_recording_gives_its_base_motion(files):
    channels = {"base_acceleration_x": files.north, "base_acceleration_z": files.up, "rotation_1": files.east}
    motion = read_motion(files.netcdf(variables=channels))
    assert motion.components == {"horizontal": "x", "vertical": "z"}


def test_npz_key_finds_its_vertical(files):
    path = files.npz()
    motion = read_motion(f"{path}:q_sta_EW")
    np.testing.assert_allclose(motion.horizontal, G * files.east)
    np.testing.assert_allclose(motion.vertical, G * files.up)
    assert read_motion(f"{path}:q_sta", component="NS").components["horizontal"] == "NS"


def test_npz_statement_in_place_of_the_toml(files):
    path = files.npz(toml=None, run_1=np.round(1e4 * files.north).astype(np.int16))
    motion = read_motion({"file": f"{path}:run_1", "unit": "1e-4 g", "time_step": "10 ms"})
    np.testing.assert_allclose(motion.horizontal, G * files.north, atol=0.51e-4 * G)


def test_npz_table_beside_it_gives_step_and_confirms_the_unit(files):
    path = files.npz(toml=None, q_NS=G * files.north, q_UD=G * files.up)
    peaks = [np.max(np.abs(v)) for v in (files.north, files.up)]
    files.text("x.csv", f"id,npts,dt_s,H1,PGA_H1_g,PGA_UD_g\nq,600,0.005,NS,{peaks[0]:.4f},{peaks[1]:.4f}\n")
    assert read_motion(f"{path}:q_NS").time_step == 0.005


def test_csv_with_toml(files):
    motion = read_motion(files.csv())
    np.testing.assert_allclose(motion.horizontal, -files.north, atol=1e-9)
    np.testing.assert_allclose(motion.vertical, files.up, atol=1e-9)
    assert motion.time_step == 0.01 and any("sign of north" in note for note in motion.notes)


def test_csv_of_a_recording_takes_only_the_base(files):
    toml = (
        'time_step = "0.01 s"\n[columns]\nbase_acceleration_x = { column = "n_cm", unit = "gal" }\n'
        'rotation_1 = { column = "u_m", unit = "rad" }\n'
    )
    assert read_motion(files.csv(toml=toml)).components == {"horizontal": "x"}


def test_csv_white_space_without_header(files):
    rows = ["a line to skip", *(f"  {t:.4f}   {v:.8e}" for t, v in enumerate(files.north))]
    toml = 'time_step = 0.01\ndelimiter = " "\nskip = 1\nheader = false\n'
    toml += '[columns]\nx = { column = 2, unit = "g" }\n'
    np.testing.assert_allclose(read_motion(files.csv(rows=rows, toml=toml)).horizontal, G * files.north, atol=1e-7)


def test_written_motion_reads_back_bit_identical(files, tmp_path):
    motion = read_motion("ridgecrest_2019_ccc", component="east").cut(10.0, 30.0).scaled(0.7)
    back = read_motion(write_motion(motion, tmp_path / "out.nc"))
    assert back.fingerprint == motion.fingerprint
    assert back.components == {"horizontal": "east", "vertical": "up"}
    assert back.source["license"] == "CC0-1.0" and "Ridgecrest" in back.source["title"]
    assert [p.name for p in tmp_path.iterdir()] == ["out.nc"]


def test_shipped_records():
    assert list_shipped() == ("ridgecrest_2019_ccc", "ridgecrest_2019_clc", "ridgecrest_2019_tow2")
    for name, pga in zip(list_shipped(), (0.56668575, 0.51080223, 0.43714300), strict=True):
        motion = read_motion(name)
        assert motion.pga == pytest.approx(pga * G, rel=1e-6)
        assert motion.vertical is not None and motion.source["license"] == "CC0-1.0"
        assert read_motion(f"{name}.nc").fingerprint == motion.fingerprint


def test_names_are_found_beside_the_plan_then_here_then_in_the_data_folder(files, tmp_path, monkeypatch):
    for folder, factor in (("plans", 1.0), ("here", 2.0), ("data/motions", 3.0)):
        (tmp_path / folder).mkdir(parents=True)
        written = files.netcdf("m.nc", {"acceleration_x": factor * files.north})
        written.rename(tmp_path / folder / "m.nc")
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("ROCKING_DATA", str(tmp_path / "data"))
    peak = np.max(np.abs(files.north))
    assert read_motion("m.nc", near=tmp_path / "plans" / "plan.toml").pga == pytest.approx(peak)
    assert read_motion("m.nc").pga == pytest.approx(2 * peak)
    (tmp_path / "here" / "m.nc").unlink()
    assert read_motion("m.nc").pga == pytest.approx(3 * peak)


def test_globs_leave_vertical_components_out(files):
    files.at2_record()
    files.npz()
    names = [name.rsplit("/", 1)[1] for name in find("RSN7*.AT2", near=files.folder)]
    assert names == ["RSN7_SOME_STA000.AT2", "RSN7_SOME_STA090.AT2"]
    keys = [name.rsplit(":", 1)[1] for name in find("x.npz:q_*", near=files.folder)]
    assert keys == ["q_sta_EW", "q_sta_NS"]
    assert len(find("ridgecrest_2019_*.nc")) == 3 and find("ridgecrest_2019_clc") == ["ridgecrest_2019_clc"]


def test_threads_may_read_netcdf_at_once_and_the_lock_pickles_to_itself():
    assert pickle.loads(pickle.dumps(NETCDF_LOCK)) is NETCDF_LOCK
    seen = []
    threads = [threading.Thread(target=lambda: seen.append(read_motion("ridgecrest_2019_clc"))) for _ in range(12)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({motion.fingerprint for motion in seen}) == 1 and len(seen) == 12


def test_real_geonet_record_integrates_to_the_velocity_and_displacement_it_states():
    motion = read_motion(real("motions/formats/20161113_110300_HSES_20.V2A"), component="N10E")
    velocity, displacement = velocity_and_displacement(motion.horizontal, motion.time_step)
    assert np.max(np.abs(motion.horizontal)) == pytest.approx(2.3646)
    assert np.max(np.abs(velocity)) == pytest.approx(0.29849, rel=5e-3)
    assert np.max(np.abs(displacement)) == pytest.approx(0.099407, rel=5e-3)


def test_real_csmip_record_is_the_shipped_one():
    raw = read_motion(real("motions/formats/CICCC.V1"), component="90")
    shipped = read_motion("ridgecrest_2019_ccc", component="east")
    start = int(np.argmax(np.abs(raw.horizontal))) - int(np.argmax(np.abs(shipped.horizontal)))
    same = raw.horizontal[start : start + shipped.horizontal.size] - shipped.horizontal
    assert np.ptp(same) <= 1.1e-6 * G  # a baseline and the last of the six decimals printed


def test_real_peer_record():
    motion = read_motion(real("motions/formats/RSN1_HELENA.A_A-HMC180.AT2"))
    assert motion.horizontal.size == 5093 and motion.components == {"horizontal": "180", "vertical": "DOWN"}
    assert len(motion.notes) == 2


def test_real_collection_of_83_records():
    path = real("motions/strong_motion_83.npz")
    sources = find(f"{path}:*")
    assert len(sources) == 166
    for source in sources[::15]:
        motion = read_motion(source, vertical=True)
        assert motion.time_step == 0.005 and motion.vertical.size == motion.horizontal.size


def test_a_damaged_neighbour_of_an_at2_file_is_left_out_with_a_note(files):
    path = files.at2_record()
    whole = read_motion(path)
    other = path.with_name("RSN7_SOME_STA090.AT2")
    other.write_text("\n".join(other.read_text().splitlines()[:-3]))
    found = read_motion(path)
    np.testing.assert_array_equal(found.horizontal[: whole.horizontal.size], whole.horizontal)
    assert any(other.name in note and "left out" in note for note in found.notes)
    upward = path.with_name("RSN7_SOME_STA-UP.AT2")
    upward.write_text("\n".join(upward.read_text().splitlines()[:-3]))
    with pytest.raises(InputError, match=upward.name):
        read_motion(path)


def test_a_v2a_file_cut_between_two_components_says_so(files):
    assert not any("is it cut short" in note for note in read_motion(files.v2a()).notes)
    short = files.v2a("short.V2A", components=(("N10E", NORTH), ("N80W", EAST)))
    assert any("holds 2 components, such a file has 3" in note for note in read_motion(short).notes)


@pytest.mark.parametrize("content", ["", "garbage\n", "\0" * 400])
def test_a_vertical_neighbour_without_its_heading_is_refused(files, content):
    """It was left out without a word: the block would have been shaken otherwise."""
    path = files.at2_record()
    path.with_name("RSN7_SOME_STA-UP.AT2").write_text(content)
    with pytest.raises(InputError, match=r"RSN7_SOME_STA-UP\.AT2"):
        read_motion(path)


def test_a_channel_without_its_line_of_points_is_no_v1_file(tmp_path):
    raw = real("motions/formats/CICCC.V1").read_text("latin-1")
    for damaged in ("-35430 Accelerogram points", "99999999999 Accelerogram points"):
        path = tmp_path / "CICCC.V1"
        path.write_text(raw.replace("35430 Accelerogram points", damaged, 1), "latin-1")
        with pytest.raises(InputError, match=r"3 channels, 2 with a line"):
            read_motion(path)


def test_a_first_line_of_numbers_is_no_header(files):
    (files.folder / "bare.csv").write_text("\n".join(f"{0.1 * k},{np.sin(k)}" for k in range(50)))
    table = 'time_step = "0.01 s"\n{}[columns]\nnorth = {{ column = 2, unit = "g" }}\n'
    (files.folder / "bare.toml").write_text(table.format(""))
    with pytest.raises(InputError, match=r"line 1 holds numbers.*header = false"):
        read_motion(files.folder / "bare.csv")
    (files.folder / "bare.toml").write_text(table.format("header = false\n"))
    assert read_motion(files.folder / "bare.csv").horizontal.size == 50


@pytest.mark.parametrize("step", ["1.E-2 ", "1.0D-02 ", ".01 ", "0.0100", "1e-2 "])
def test_at2_step_in_any_notation(files, step):
    path = files.at2("NEW_000.AT2", files.north, "000", header=f"NPTS=  600, DT=  {step}SEC")
    assert read_motion(path).time_step == 0.01


@pytest.mark.parametrize(
    "name", ["HGZ", "HNZ", "az", "acc_z", "vz", "Vertikal", "z (up)", "a_up", "UD1", "V", "acc UD"]
)
def test_names_of_vertical_components(name):
    assert vertical_sign(name) == 1


@pytest.mark.parametrize(
    "name",
    [
        "HGN",
        "HNE",
        "N",
        "x",
        "AZ.BZN..HHE",
        "AZ_HNE",
        "az090",
        "down-hole 090",
        "hne_up",
        "vertical_x",
        "acc_x",
        "000",
        "N00E_v2",
        "h1_up_x",
        "Transversal",
        "S80E",
    ],
)
def test_names_of_horizontal_components(name):
    assert vertical_sign(name) == 0


def test_a_component_that_points_down():
    assert vertical_sign("acc_down") == vertical_sign("DWN") == -1
