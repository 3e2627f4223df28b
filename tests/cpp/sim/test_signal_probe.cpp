#include "echopath/sim/stream/signal_probe.h"

#include <gtest/gtest.h>

#include <cmath>

namespace echopath::test_signal_probe {
namespace {

ProbedChirp compared(double power, double phase_error, double amplitude_error) {
  ProbedChirp chirp;
  chirp.num_echoes = 1;
  chirp.compared_power = chirp.strongest_power = power;
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

// Fields and powers of two records of one chirp add up; of what is the largest of each record the larger one stays.
TEST(SignalProbe, RecordsOfAChirpAddUp) {
  ProbedChirp one = compared(9.0, 0.2, 1.0), other = compared(16.0, 0.1, 0.25);
  one.shares.resize(2), other.shares.resize(2);
  one.amplitude_sum = 3.0, other.amplitude_sum = 4.5;
  one.power_sum = 10.0, other.power_sum = 20.0;
  one.value[7] = {1.0, -2.0}, other.value[7] = {0.5, 0.25};
  one.shares[1].power = 2.0, other.shares[1].power = 0.75;
  one.shares[0].field[3] = {0.0, 1.0}, other.shares[0].field[3] = {2.0, 3.0};
  for (const bool is_first : {false, true}) {
    one.strongest = is_first ? 5.0 : 1.0, other.strongest = 3.0;
    one.largest_phase_error = is_first ? 0.3 : 0.6, other.largest_phase_error = 0.4;
    ProbedChirp both = one;
    both.add(other);
    EXPECT_EQ(both.amplitude_sum, 7.5);
    EXPECT_EQ(both.power_sum, 30.0);
    EXPECT_EQ(both.value[7], (std::complex<double>{1.5, -1.75}));
    EXPECT_EQ(both.shares[1].power, 2.75);
    EXPECT_EQ(both.shares[0].field[3], (std::complex<double>{2.0, 4.0}));
    EXPECT_EQ(both.strongest, is_first ? 5.0 : 3.0);
    EXPECT_EQ(both.largest_phase_error, is_first ? 0.4 : 0.6);
  }
}

// Where all echoes of both records should be nothing, the larger error stays.
TEST(SignalProbe, ErrorsOfNothingStay) {
  ProbedChirp nothing = compared(0.0, 0.0, 0.0);
  nothing.add(compared(0.0, 0.0, 1.0));
  EXPECT_EQ(nothing.amplitude_error, 1.0);
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
