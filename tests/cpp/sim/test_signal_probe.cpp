#include "echopath/sim/stream/signal_probe.h"

#include <gtest/gtest.h>

#include <cmath>

namespace echopath::test_signal_probe {
namespace {

ProbedChirp compared(double power, double phase_error, double amplitude_error) {
  ProbedChirp chirp;
  chirp.num_echoes = 1;
  chirp.compared_power = power;
  chirp.phase_error = phase_error;
  chirp.amplitude_error = amplitude_error;
  return chirp;
}

// Differences squared add up, and so do amplitudes squared: 9 + 1 of 25 in rms.
TEST(SignalProbe, ErrorsOfRecordsCountByTheirPower) {
  ProbedChirp both = compared(9.0, 0.2, 1.0);
  both.add(compared(16.0, 0.1, 0.25));
  EXPECT_DOUBLE_EQ(both.amplitude_error, std::sqrt(10.0 / 25.0));
  EXPECT_DOUBLE_EQ(both.phase_error, std::sqrt((0.04 * 9.0 + 0.01 * 16.0) / 25.0));
  EXPECT_DOUBLE_EQ(both.compared_power, 25.0);
  EXPECT_EQ(both.num_echoes, 2);
}

// Surface that comes into view may bring 1e-60 W, of which rounding is 1e22 times as much.
TEST(SignalProbe, ARecordThatBringsNextToNothingDoesNotStandForAll) {
  for (const bool is_first : {false, true}) {
    ProbedChirp both = is_first ? compared(1e-60, 0.0, 1e22) : compared(1e-6, 0.0, 1e-5);
    both.add(is_first ? compared(1e-6, 0.0, 1e-5) : compared(1e-60, 0.0, 1e22));
    EXPECT_NEAR(both.amplitude_error, std::sqrt(1e-10 + 1e-10), 1e-12);
  }
  ProbedChirp nothing = compared(0.0, 0.0, 0.0);
  nothing.add(compared(0.0, 0.0, 0.0));
  EXPECT_EQ(nothing.amplitude_error, 0.0);
}

}  // namespace
}  // namespace echopath::test_signal_probe
