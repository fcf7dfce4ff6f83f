"""The Python package against files of the repository and against itself."""
import csv
import inspect
import pathlib
import re
import shutil
import sys
import typing

import numpy as np
import pytest

import racbot

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
SET = DATA / "runs" / "wheel-skew"


def test_a_run_has_the_columns_of_its_file():
    path = sorted(SET.glob("*.csv"))[0]
    run = racbot.read_run(path)
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for name in ("t", "cmd_vy", "ref_1", "enc_3", "duty_2", "cam_theta"):
        theirs = np.array([float(row[name]) if row[name] else np.nan for row in rows])
        np.testing.assert_array_equal(run[name], theirs)


def test_columns_are_their_readers_own():
    path = sorted(SET.glob("*.csv"))[0]
    run = racbot.read_run(path)
    run["t"] -= run["t"][0] - 1.0
    assert run["t"][0] == 1.0 and racbot.read_run(path)["t"][0] == 0.0
    track = racbot.simulate(limit_s=0.1)[2]
    track[:, 0] += 5.0
    assert track[0, 0] >= 5.0


def test_paths_are_what_python_takes_for_paths(tmp_path):
    path = sorted(SET.glob("*.csv"))[0]
    latin = bytes(tmp_path) + b"/run_\xff.csv"
    shutil.copy(path, latin)
    for same in (str(path), bytes(path), latin):
        np.testing.assert_array_equal(racbot.read_run(same)["t"], racbot.read_run(path)["t"])
    for wrong in (None, 3, ["a.csv"]):
        with pytest.raises(TypeError):
            racbot.read_run(wrong)
        with pytest.raises(TypeError):
            racbot.check(wrong)


def test_whatever_is_public_has_hints_and_says_what_it_does():
    assert (pathlib.Path(racbot.__file__).parent / "py.typed").exists()
    for name in racbot.__all__:
        thing = getattr(racbot, name)
        assert thing.__doc__, name
        if inspect.isfunction(thing):
            hints = typing.get_type_hints(thing)
            assert set(hints) == set(inspect.signature(thing).parameters) | {"return"}, name


def test_mistakes_are_one_kind_of_exception_with_what_to_do():
    with pytest.raises(racbot.RacbotError, match="none.csv"):
        racbot.read_run("none.csv")
    with pytest.raises(racbot.RacbotError, match="robot.toml"):
        racbot.gap(DATA / "nowhere")
    with pytest.raises(racbot.RacbotError, match="twists"):
        racbot.wheel_words(None, [(np.nan, 0, 0)])
    with pytest.raises(racbot.RacbotError, match=r"twists: row 1 has 2 numbers; give \(vx, vy, omega\)"):
        racbot.wheel_words(None, [(1.0, 0)])
    with pytest.raises(racbot.RacbotError, match="set_points: row 2 has 3 numbers"):
        racbot.simulate(set_points=[(1, 0, 1, 0), (1, 0, 1)])


def test_a_simulated_drive_is_a_log_that_calibrates(tmp_path):
    hidden = tmp_path / "hidden.toml"
    columns, toml, track = racbot.simulate(limit_s=0.5)
    assert len(columns["t"]) == len(track) == 500 and columns["duty_1"].dtype == np.float64
    skewed = toml.replace("skew_rad = [0.0, 0.0, 0.0]", "skew_rad = [0.07, -0.05, 0.03]")
    assert skewed != toml
    hidden.write_text(skewed)
    astray = racbot.simulate(hidden=hidden, limit_s=5.0)[2]
    ideal = racbot.simulate(limit_s=5.0)[2]
    assert np.hypot(*(astray[-1, 1:3] - ideal[-1, 1:3])) > 0.05
    again = racbot.simulate(hidden=hidden, limit_s=5.0)[2]
    np.testing.assert_array_equal(astray, again)


def test_calibrate_and_check_of_a_data_set():
    found = racbot.calibrate(SET)
    assert racbot.check(SET) == []
    assert len(found["skew_rad"]) == 3 and max(abs(skew) for skew in found["skew_rad"]) > 0.02


def test_a_set_that_is_set_up_wrong_is_refused_as_the_command_refuses_it(tmp_path):
    wrong = tmp_path / "diameter.toml"
    toml = (SET / "robot.toml").read_text()
    radius = re.search(r"wheel_radius_m = ([0-9.]+)", toml)
    wrong.write_text(toml.replace(radius[0], f"wheel_radius_m = {2 * float(radius[1])}"))
    assert "diameter" in racbot.check(SET, robot=wrong)[0]
    for analysis in (racbot.gap, racbot.calibrate):
        with pytest.raises(racbot.RacbotError, match="set up wrong: .*diameter"):
            analysis(SET, robot=wrong)
    assert "diameter" in racbot.gap(SET, robot=wrong, despite_mistakes=True)["set_up_mistakes"][0]


def test_the_words_are_those_that_the_card_computes():
    rng = np.random.default_rng(1)
    for twist in rng.uniform([-1, -1, -6], [1, 1, 6], (20, 3)):
        robot = racbot.BitTrueRobot()
        # Two ticks: the set point acts at the first, the snapshot shows it.
        robot.step(*twist, 2)
        _, set_points, _, _ = robot.words()
        assert racbot.wheel_words(None, [twist])[0].tolist() == set_points


def test_the_environment_keeps_gymnasiums_rules_and_can_be_solved():
    gymnasium = pytest.importorskip("gymnasium")
    import racbot.environment
    from gymnasium.utils.env_checker import check_env

    check_env(gymnasium.make("racbot/Reach-v0").unwrapped, skip_render_check=True)
    env = gymnasium.make("racbot/Reach-v0")
    seen, _ = env.reset(seed=3)
    for _ in range(600):
        x, y, sine, cosine = seen[:4]
        # Straight at it: the body velocity is the error times 1.5 /s.
        action = 1.5 * np.array([x, y, np.arctan2(sine, cosine)]) / racbot.environment.LARGEST
        seen, _, there, late, _ = env.step(np.clip(action, -1, 1).astype(np.float32))
        if there or late:
            break
    assert there


def test_many_logs_are_judged_by_dask(tmp_path):
    pytest.importorskip("dask")
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "examples"))
    import judge_folder

    for name in ("first", "second"):
        shutil.copytree(DATA / "real" / "differential-squares", tmp_path / name)
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "robot.toml").write_text("wheels = none\n")
    broken, first, second = judge_folder.judge_all(tmp_path)
    assert first["verdict"] == second["verdict"] and first["effects"] == second["effects"]
    assert first["effects"] == ["camera-clock", "body-radius"]
    assert broken["verdict"] == "error" and "robot.toml" in broken["effects"][0]
