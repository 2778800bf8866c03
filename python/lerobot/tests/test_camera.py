"""Tests of a sensor that is read as a camera."""

import time
from pathlib import Path

import numpy as np
import pytest
from board import RATE_HZ, Board
from lerobot.utils.errors import DeviceAlreadyConnectedError, DeviceNotConnectedError

import twintac
from lerobot_camera_twintac import TaxelPicture, TwintacCamera, TwintacCameraConfig

TOUCHED_KPA = [0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, -5.0]


def over_udp(board: Board, **fields: object) -> TwintacCamera:
    """A camera that reads the board's datagrams."""
    return TwintacCamera(TwintacCameraConfig(udp=board.address, line=str(board.line), **fields))  # type: ignore[arg-type]


def readings_kpa(camera: TwintacCamera, picture: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
    assert isinstance(camera.picture, TaxelPicture)
    return camera.picture.readings_kpa(picture)


def test_the_emulated_sensor_gives_pictures_at_its_own_rate() -> None:
    with TwintacCamera(TwintacCameraConfig(lab=True)) as camera:
        pictures = [camera.read_latest(), camera.read(), camera.async_read(), camera.read_latest()]
        assert camera.provenance == "emulated"
        for picture in pictures:
            assert picture.shape == (64, 96, 3) and picture.dtype == np.uint8
        assert camera.reading is not None
        exact_kpa = camera.reading.readings_kpa
        assert np.abs(readings_kpa(camera, pictures[-1]) - exact_kpa).max() <= camera.scale.kpa_per_level / 2
        begin = camera.reading.sequence
        started_s = time.monotonic()
        for _ in range(20):
            camera.async_read()
        assert time.monotonic() - started_s > 10 / 200  # each waits for a new frame
        assert camera.reading.sequence >= begin + 20
    assert not camera.is_connected


@pytest.mark.parametrize("source", ["udp", "serial"])
def test_a_picture_shows_what_the_sensor_reads(source: str, board: Board) -> None:
    address = {"udp": board.address, "serial": board.port}[source]
    config = TwintacCameraConfig(line=str(board.line), **{source: address})  # type: ignore[arg-type]
    with TwintacCamera(config) as camera:
        np.testing.assert_array_equal(readings_kpa(camera, camera.read()), 0.0)
        board.touch(TOUCHED_KPA)
        for picture in (camera.read(), camera.async_read(), camera.read_latest()):
            # multiples of a grey level
            np.testing.assert_array_equal(readings_kpa(camera, picture), TOUCHED_KPA)
        assert camera.provenance == "real"


def test_a_map_shows_the_pressure_between_the_taxels(board: Board) -> None:
    with over_udp(board, picture="map", width=34, height=18) as camera:
        board.touch([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 30.0])  # t7 is at (12, 4) mm
        pressure_kpa = camera.scale.pressure_kpa(camera.read()[:, :, 0])
    quarters_kpa = [pressure_kpa[rows, columns].mean() for rows in (slice(9), slice(9, 18)) for columns in (slice(17), slice(17, 34))]
    assert np.argmax(quarters_kpa) == 1  # top left, top right, bottom left, bottom right
    assert 15.0 < pressure_kpa[9 - 4, 17 + 12] <= 40.0  # a pixel is 1 mm
    assert abs(pressure_kpa[9 + 4, 17 - 12]) < 3.0


def test_a_taxel_without_a_reading_is_black(board: Board) -> None:
    with over_udp(board) as camera:
        board.touch([float("nan"), *TOUCHED_KPA[1:]])
        picture = camera.read()
        found_kpa = readings_kpa(camera, picture)
        assert np.isnan(found_kpa[0]) and np.array_equal(found_kpa[1:], TOUCHED_KPA[1:])
        assert picture.min() == 0


def test_readings_beyond_the_scale_are_clipped_and_said_once(board: Board, caplog: pytest.LogCaptureFixture) -> None:
    with over_udp(board, full_scale_kpa=16.0) as camera:
        board.touch([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 17.0, -9.0])
        found_kpa = [readings_kpa(camera, camera.read()) for _ in range(3)][-1]
    np.testing.assert_allclose(found_kpa[-2:], [16.0, -7.9])
    assert [record.message for record in caplog.records if "beyond the scale" in record.message] == [
        f"twintac camera (udp {board.address}): a reading is beyond the scale, -7.9 to 16 kPa, and clipped in the picture: give a larger full_scale_kpa"
    ]


def test_a_frame_that_is_too_old_is_an_error(board: Board) -> None:
    with over_udp(board) as camera:
        camera.read()
        board.touch(TOUCHED_KPA)  # more frames come
        board.is_sending = False
        time.sleep(0.2)
        with pytest.raises(TimeoutError, match=r"the newest frame is \d+ ms old, more than 100 ms"):
            camera.read_latest(max_age_ms=100)
        assert camera.read_latest(max_age_ms=1000).shape == (64, 96, 3)
        camera.async_read(timeout_ms=10)  # `async_read` has not returned the last frame yet
        with pytest.raises(TimeoutError, match="no new frame within 50 ms; the newest is"):
            camera.async_read(timeout_ms=50)
        board.is_sending = True
        camera.async_read(timeout_ms=1000)
        board.is_sending = False
        time.sleep(0.7)
        with pytest.raises(TimeoutError, match="no new frame within 10 ms"):
            camera.async_read(timeout_ms=10)  # a newer frame has arrived, but it is stale
        board.is_sending = True
        camera.async_read(timeout_ms=1000)


def test_a_sensor_that_stops_is_said_and_can_be_connected_again(board: Board) -> None:
    camera = over_udp(board)
    camera.connect()
    board.is_sending = False
    with pytest.raises(RuntimeError, match=r"twintac camera \(udp .*\) has stopped: .*; remove the cause"):
        for _ in range(100):  # frames in transit, then the wait until the reader gives up
            camera.read()
    for read in (camera.read, camera.async_read, camera.read_latest):
        with pytest.raises(RuntimeError, match="has stopped"):
            read()
    assert camera.is_connected  # robots check this before they disconnect
    camera.disconnect()
    board.is_sending = True
    with camera:
        assert camera.read().shape == (64, 96, 3)


def test_reading_needs_a_connection(board: Board) -> None:
    camera = over_udp(board)
    for use in (camera.read, camera.async_read, camera.read_latest, camera.disconnect):
        with pytest.raises(DeviceNotConnectedError, match=r"is not connected: call connect\(\) first"):
            use()
    camera.connect()
    with pytest.raises(DeviceAlreadyConnectedError, match=r"call disconnect\(\) first"):
        camera.connect()
    camera.disconnect()
    with pytest.raises(DeviceNotConnectedError):
        camera.read()


def test_without_warm_up_there_may_be_no_frame_yet(board: Board) -> None:
    camera = over_udp(board)
    camera.connect(warmup=False)
    try:
        time.sleep(5 / RATE_HZ)
        camera.read_latest()
    finally:
        camera.disconnect()


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"bus": "/dev/i2c-nowhere"}, r"twintac camera \(bus /dev/i2c-nowhere\) cannot be connected: .*i2c-nowhere"),
        ({"serial": "/dev/tty-nowhere", "line": "LINE"}, "tty-nowhere"),
        ({"udp": "127.0.0.1:9", "line": "no-such-line.toml"}, "no-such-line.toml"),
        ({"replay": "no-such-log.mcap"}, "no-such-log.mcap"),
    ],
)
def test_a_source_that_is_not_there_is_named(fields: dict[str, str], message: str, board: Board) -> None:
    fields = {name: str(board.line) if value == "LINE" else value for name, value in fields.items()}
    camera = TwintacCamera(TwintacCameraConfig(**fields))  # type: ignore[arg-type]
    with pytest.raises(ConnectionError, match=message):
        camera.connect()
    assert not camera.is_connected


def test_a_silent_source_cannot_be_connected(board: Board) -> None:
    board.is_sending = False
    camera = over_udp(board)
    with pytest.raises(ConnectionError, match="cannot be connected: "):
        camera.connect()
    board.is_sending = True
    with camera:
        camera.read()


def test_a_missing_sensor_description_is_named_before_connecting() -> None:
    with pytest.raises(twintac.Error, match="no-such-sensor.toml"):
        TwintacCamera(TwintacCameraConfig(lab=True, sensor="no-such-sensor.toml"))


def test_a_picture_too_small_for_the_taxels_is_an_error() -> None:
    with pytest.raises(ValueError, match=r"taxel t\d has no pixel in a picture of 2 × 2; give a larger width and height"):
        TwintacCamera(TwintacCameraConfig(lab=True, width=2, height=2))


def test_a_robot_faster_than_the_sensor_is_said(board: Board, caplog: pytest.LogCaptureFixture) -> None:
    with over_udp(board, fps=200):
        pass
    assert "the robot asks for 200 pictures a second, the sensor is described with 55 Hz: pictures may repeat" in caplog.text


def test_what_is_found_has_fields_of_the_configuration() -> None:
    found = TwintacCamera.find_cameras()
    assert found[0]["id"] == "lab"
    for source in found:
        fields = {name: value for name, value in source.items() if name not in ("type", "name", "id")}
        assert TwintacCameraConfig(**fields, line="board.toml" if "serial" in fields else None).source in fields


def test_a_camera_that_is_forgotten_ends_its_reading(board: Board) -> None:
    camera = over_udp(board)
    camera.connect()
    del camera
    with over_udp(board) as again:  # the address is free
        again.read()
