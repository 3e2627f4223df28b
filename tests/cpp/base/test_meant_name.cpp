#include "echopath/base/text/meant_name.h"

#include <gtest/gtest.h>

namespace echopath::test_meant_name {
namespace {

using Names = std::vector<std::string>;

const Names kOfChirps = {"start_frequency", "bandwidth",      "num_samples", "sampling_rate",
                         "num_chirps",      "chirp_interval", "real"};
const Names kOfRadar = {"waveform", "transmitters", "receivers", "position",       "yaw",
                        "pitch",    "motion",       "speed",     "transmit_power", "noise_figure_db"};

TEST(MeantName, TakesSlipsOfThePen) {
  EXPECT_EQ(meant_name("bandwitdh", kOfChirps), "bandwidth");
  EXPECT_EQ(meant_name("num_chirp", kOfChirps), "num_chirps");
  EXPECT_EQ(meant_name("Bandwidth", kOfChirps), "bandwidth");
  EXPECT_EQ(meant_name("reciever", kOfRadar), "receivers");  // two letters swapped, one left out
}

TEST(MeantName, KnowsWhatOthersCallIt) {
  EXPECT_EQ(meant_name("fc", kOfChirps), "start_frequency");
  EXPECT_EQ(meant_name("f0", kOfChirps), "start_frequency");
  EXPECT_EQ(meant_name("fc", {"scene", "frequency"}), "frequency");
  EXPECT_EQ(meant_name("velocity", kOfRadar), "speed");
  EXPECT_EQ(meant_name("tx", kOfRadar), "transmitters");
  EXPECT_EQ(meant_name("rx", kOfRadar), "receivers");
  EXPECT_EQ(meant_name("heading", kOfRadar), "yaw");
  EXPECT_EQ(meant_name("hanning", {"rect", "hann", "hamming", "blackman_harris"}), "hann");
}

TEST(MeantName, TakesAWordOfAName) {
  EXPECT_EQ(meant_name("frequency", kOfChirps), "start_frequency");
  EXPECT_EQ(meant_name("noise_figure", kOfRadar), "noise_figure_db");
  EXPECT_EQ(meant_name("start_freq", kOfChirps), "start_frequency");
  EXPECT_EQ(meant_name("speed_in_kmh", kOfRadar), "speed");
}

TEST(MeantName, NamesNothingUnlike) {
  EXPECT_EQ(meant_name("fc", {"real", "name"}), "");  // what was said before: 'real'
  EXPECT_EQ(meant_name("nonsense", kOfRadar), "");
  EXPECT_EQ(meant_name("velocity", {"waveform", "transmitters"}), "");
  EXPECT_EQ(meant_name("x", {"u", "v"}), "");
  EXPECT_EQ(meant_name("", kOfRadar), "");
  EXPECT_EQ(meant_name("pad", {}), "");
}

}  // namespace
}  // namespace echopath::test_meant_name
