#include "echopath/radar/gaussian_beam.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"

namespace echopath {
namespace {

constexpr double kNarrowest = 1e-6;        // rad, of beams
constexpr double kReach = 2.6;             // widths
constexpr double kSamplesOfAWidth = 12.0;  // between which bicubics err by less than 1e-4 of the peak

std::vector<double> samples_about(double width) {
  const double reach = std::min(0.5 * kPi, kReach * width);
  const int beside = static_cast<int>(std::ceil(kSamplesOfAWidth * reach / width));
  std::vector<double> angles;
  for (int i = -beside; i <= beside; ++i) angles.push_back(reach * i / beside);
  return angles;
}

}  // namespace

GainTable gaussian_beam(double azimuth, double elevation, std::optional<double> peak_gain) {
  const auto require_width = [](double width, const char* argument) {
    require(width >= kNarrowest && width <= kPi, argument, "must be a width in rad, from 1e-6 to pi", width);
  };
  require_width(azimuth, "azimuth");
  require_width(elevation, "elevation");
  const std::vector<double> across = samples_about(azimuth), up = samples_about(elevation);
  std::vector<double> gain;
  for (const double v : up) {
    for (const double u : across)
      gain.push_back(std::exp2(-4.0 * (u * u / (azimuth * azimuth) + v * v / (elevation * elevation))));
  }
  const GainTable lossless(across, up, gain, {}, GainTable::Scale::kMeanOfOne);
  if (!peak_gain) return lossless;
  const double most = lossless.peak_gain();
  require(*peak_gain > 0.0 && *peak_gain <= kLargestEfficiency * most, "peak_gain",
          streamed("must be positive and at most that of a beam of these widths without losses, ", most), *peak_gain);
  for (double& sample : gain) sample *= *peak_gain;
  return GainTable(across, up, std::move(gain));
}

}  // namespace echopath
