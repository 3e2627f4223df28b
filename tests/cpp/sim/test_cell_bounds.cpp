#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>

#include "cpp/sim/slow_map.h"
#include "cpp/support/scenes.h"
#include "cpp/support/waveforms.h"
#include "echopath/sim/cells/cell_bounds.h"

namespace echopath::test_cell_bounds {
namespace {

using namespace testing;

constexpr double kRounding = 1e-9;  // relative: amplitudes are bounded in single precision
// Of the bound of one echo at rest over its power at the peak: kSpare^2, and the response of the window within its own
// quarter of a cell and that of its bin counts as 1.
constexpr double kLoose = 1.25;

Radar radar_of(bool real = false) {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.waveform = small_waveform(5e8, 10e6, 32, 16);
  radar.waveform.real = real;
  return radar;
}

double delay_of_cell(const ChirpSequence& waveform, double cell) {
  return cell * waveform.sampling_rate / (waveform.num_samples * waveform.slope());
}

// Echoes that approach or recede, with amplitudes that swell and fade, at the time of each chirp.
struct Crowd {
  Echoes block;
  std::vector<std::vector<ChirpEcho>> by_chirp;  // [chirp][echo]

  Crowd(const ChirpSequence& waveform, int num_echoes, double fastest) {
    std::mt19937 draw(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<double> times;
    for (int c = 0; c < waveform.num_chirps; ++c) times.push_back(c * waveform.chirp_interval);
    block.sampling = exact_sampling(times);
    block.num_echoes = num_echoes;
    by_chirp.resize(times.size());
    std::vector<double> delay, speed, phase, size;
    for (int i = 0; i < num_echoes; ++i) {
      delay.push_back(delay_of_cell(waveform, 3.0 + (waveform.real ? 10.0 : 25.0) * share(draw)));
      speed.push_back(2.0 * fastest * (2.0 * share(draw) - 1.0) / 3e8);
      phase.push_back(2.0 * std::numbers::pi * share(draw));
      size.push_back(1e-3 * (0.2 + share(draw)));
    }
    for (size_t c = 0; c < times.size(); ++c) {
      for (size_t i = 0; i < delay.size(); ++i) {
        const double swell = 1.0 + 0.2 * std::sin(phase[i] + 0.2 * static_cast<double>(c));
        by_chirp[c].push_back({delay[i] + speed[i] * times[c], speed[i], std::polar(size[i] * swell, phase[i])});
        block.delay.push_back(by_chirp[c].back().delay);
        block.amplitude.push_back(by_chirp[c].back().amplitude);
      }
    }
  }

  // The samples [chirp, sample] of the echoes of a group.
  std::vector<std::complex<double>> samples(const ChirpSequence& waveform, const std::vector<uint32_t>& group,
                                            uint32_t which) const {
    std::vector<std::complex<double>> out(static_cast<size_t>(waveform.num_chirps * waveform.num_samples));
    for (size_t c = 0; c < by_chirp.size(); ++c) {
      for (size_t i = 0; i < group.size(); ++i) {
        if (group[i] == which)
          add_samples(waveform, by_chirp[c][i], out.data() + c * static_cast<size_t>(waveform.num_samples));
      }
    }
    return out;
  }
};

std::vector<double> bounds_of(const Radar& radar, const Crowd& crowd, const std::vector<uint32_t>& group,
                              uint32_t num_groups, const Window& window, int zero_pad) {
  CellBounds bounds(crowd.block.num_echoes, radar, false);
  std::vector<int64_t> first;
  for (int64_t i = 0; i < crowd.block.num_echoes; ++i) first.push_back(i);
  bounds.see({&crowd.block, 1}, first);
  return bounds.bounds(group, num_groups, window, zero_pad);
}

TEST(CellBounds, HoldForTheSlowSumsOfGroups) {
  const std::vector<uint32_t> group{0, 1, 0, 2, 1, 1, 2, 0, 1, 0, 2, 1};
  for (const bool real : {false, true}) {
    for (const auto& [name, zero_pad] : {std::pair("hann", 1), std::pair("rect", 2), std::pair("chebyshev", 1)}) {
      const Radar radar = radar_of(real);
      const Window window = Window::named(name);
      const Crowd crowd(radar.waveform, 12, 80.0);
      const std::vector<double> bounds = bounds_of(radar, crowd, group, 3, window, zero_pad);
      const auto num_ranges = bounds.size() / 3;
      for (uint32_t g = 0; g < 3; ++g) {
        std::vector<std::complex<double>> samples = crowd.samples(radar.waveform, group, g);
        // A map of real samples is that of sqrt(2) times their sum's real part, times sqrt(2) once more.
        for (std::complex<double>& sample : samples) sample = real ? 2.0 * sample.real() : sample;
        const std::vector<double> power = slow_power(samples, radar.waveform, window, zero_pad);
        const auto columns = static_cast<size_t>(zero_pad * radar.waveform.num_samples);
        for (size_t cell = 0; cell < power.size(); ++cell) {
          if (cell % columns >= num_ranges) continue;
          ASSERT_LE(power[cell], (1.0 + kRounding) * bounds[g * num_ranges + cell % columns]) << name << " cell " << cell;
        }
      }
    }
  }
}

// One echo with a way and an amplitude in each chirp.
Crowd one_echo(const ChirpSequence& waveform, const std::function<double(int)>& cell, double rate,
               const std::function<double(int)>& amplitude) {
  Crowd crowd(waveform, 1, 0.0);
  for (int c = 0; c < waveform.num_chirps; ++c) {
    const auto at = static_cast<size_t>(c);
    ChirpEcho& echo = crowd.by_chirp[at].front();
    echo = {delay_of_cell(waveform, cell(c)), rate, amplitude(c)};
    crowd.block.delay[at] = echo.delay;
    crowd.block.amplitude[at] = echo.amplitude;
  }
  return crowd;
}

// The bounds of one echo are close to its power, so that each thing that they allow for counts.
void expect_bounded(const Radar& radar, const Crowd& crowd, const Window& window, const std::string& what) {
  const std::vector<double> bounds = bounds_of(radar, crowd, {0}, 1, window, 1);
  std::vector<std::complex<double>> samples = crowd.samples(radar.waveform, {0}, 0);
  for (std::complex<double>& sample : samples) sample = radar.waveform.real ? 2.0 * sample.real() : sample;
  const std::vector<double> power = slow_power(samples, radar.waveform, window, 1);
  const auto columns = static_cast<size_t>(radar.waveform.num_samples);
  for (size_t cell = 0; cell < power.size(); ++cell) {
    if (cell % columns >= bounds.size()) continue;
    ASSERT_LE(power[cell], (1.0 + kRounding) * bounds[cell % columns]) << what << ", cell " << cell;
  }
}

TEST(CellBounds, HoldForOneEchoWhateverItDoes) {
  const Window hann = Window::named("hann"), rect = Window::named("rect");
  const auto one = [](int) { return 1.0; };
  const Radar radar = radar_of();
  const ChirpSequence& waveform = radar.waveform;
  const int last = waveform.num_chirps - 1;
  // The delay that grows within each chirp as fast as this shifts the beat by two cells.
  const double rate = 2.0 * waveform.sampling_rate / waveform.num_samples / waveform.start_frequency;
  const Crowd fast = one_echo(
      waveform, [&](int c) { return 10.0 + c * waveform.chirp_interval * rate / delay_of_cell(waveform, 1.0); }, rate, one);
  expect_bounded(radar, fast, hann, "Doppler shift");
  expect_bounded(radar, one_echo(waveform, [](int) { return 12.0; }, 0.0, [&](int c) { return c == last ? 1.0 : 0.0; }),
                 hann, "the last chirp alone");
  expect_bounded(
      radar, one_echo(waveform, [](int) { return 12.0; }, 0.0, [&](int c) { return c % 2 == 1 && c != last ? 1.04 : 1.0; }),
      rect, "more between the chirps that are looked at");
  const Radar real = radar_of(true);
  expect_bounded(real, one_echo(real.waveform, [](int) { return 1.3; }, 0.0, one), rect, "negative frequencies");
}

TEST(CellBounds, WithTheDelayOfEverySampleAreThoseOfTheAmplitudeAlone) {
  const Radar radar = radar_of();
  const Crowd crowd(radar.waveform, 1, 0.0);
  CellBounds bounds(1, radar, true);
  const std::vector<int64_t> first{0};
  bounds.see({&crowd.block, 1}, first);
  double largest = 0.0;
  for (const std::complex<double>& amplitude : crowd.block.amplitude) largest = std::max(largest, std::norm(amplitude));
  for (const double bound : bounds.bounds(std::vector<uint32_t>{0}, 1, Window{}, 1)) {
    EXPECT_GE(bound, 0.99 * largest);  // of which about every second chirp is looked at
    EXPECT_LE(bound, kLoose * largest);
  }
}

TEST(CellBounds, AreCloseToTheNumberThatOneEchoShows) {
  const Radar radar = radar_of();
  Crowd crowd(radar.waveform, 1, 0.0);
  const double cell = 12.0, amplitude = 2e-3;
  for (double& delay : crowd.block.delay) delay = delay_of_cell(radar.waveform, cell);
  for (std::complex<double>& one : crowd.block.amplitude) one = amplitude;
  const std::vector<double> bounds = bounds_of(radar, crowd, {0}, 1, Window{}, 1);
  EXPECT_GE(bounds[12], amplitude * amplitude);
  EXPECT_LE(bounds[12], kLoose * amplitude * amplitude);
  EXPECT_LT(bounds[20], 1e-3 * amplitude * amplitude);  // Hann: 8 cells aside, 1 taken for its reach
}

TEST(CellBounds, GroupsThatAreNotAskedForCountNowhere) {
  const Radar radar = radar_of();
  const Crowd crowd(radar.waveform, 2, 5.0);
  const std::vector<double> alone = bounds_of(radar, crowd, {0, 7}, 1, Window{}, 1),
                            other = bounds_of(radar, crowd, {7, 0}, 1, Window{}, 1);
  const std::vector<double> both = bounds_of(radar, crowd, {0, 0}, 1, Window{}, 1);
  for (size_t r = 0; r < both.size(); ++r) {
    EXPECT_NEAR(std::sqrt(both[r]), std::sqrt(alone[r]) + std::sqrt(other[r]), 1e-12);
  }
}

TEST(CellBounds, EchoesBeyondTheFilterAreSilent) {
  const Radar radar = radar_of();
  Crowd crowd(radar.waveform, 1, 0.0);
  for (double& delay : crowd.block.delay) delay = delay_of_cell(radar.waveform, 33.0);
  for (const double bound : bounds_of(radar, crowd, {0}, 1, Window{}, 1)) EXPECT_EQ(bound, 0.0);
}

}  // namespace
}  // namespace echopath::test_cell_bounds
