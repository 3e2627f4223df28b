"""A configuration of a TI sensor with two transmitters that take turns and four receivers, and its numbers."""

CONFIGURATION = """% Platform : xWR68xx
dfeDataOutputMode 1
channelCfg 15 5 0
adcCfg 2 1
adcbufCfg -1 0 1 1 1
profileCfg 0 60 7 6 40 0 0 70 1 128 5000 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 32 0 50 1 0
guiMonitor -1 1 1 0 0 0 1
sensorStart
"""
RATE, COUNT, SLOPE, INTERVAL = 5e6, 128, 70e12, 47e-6  # 1/s, samples, Hz/s, s
START = 60e9 + SLOPE * 6e-6  # Hz
