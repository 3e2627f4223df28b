"""Tables of scene files that several tests begin with."""
WAVEFORM = """
[radar.waveform]
start_frequency = 77e9
bandwidth = 1e9
num_samples = 64
sampling_rate = 20e6
num_chirps = 8
chirp_interval = 100e-6
"""
SMALL_WAVEFORM = """
[radar.waveform]
start_frequency = 77e9
bandwidth = 1e9
num_samples = 32
sampling_rate = 10e6
num_chirps = 8
chirp_interval = 1e-4
"""
# That waveform from antennas 1 m above the ground.
SMALL_RADAR = SMALL_WAVEFORM + """\
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
"""
ANTENNAS = """
[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
[[radar.receivers]]
position = [0.0, 0.01, 0.0]
"""


def moving_plate(name: str, width: float, height: float, x: float, velocity: float) -> str:
    """The table of a diffuse plate at (x, 0, 1) in m that looks back along x; width, height: m; velocity: m/s along x"""
    return f"""
[[objects]]
name = "{name}"
actor = "plate"
parameters = {{width = {width}, height = {height}}}
position = [{x}, 0.0, 1.0]
yaw_deg = 180.0
material = {{reflectivity = 0.27, scattering = 1.0}}
motion = {{kind = "linear", velocity = [{velocity}, 0.0, 0.0]}}
"""
