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
