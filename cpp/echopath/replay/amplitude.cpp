#include "echopath/replay/amplitude.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/replay/diffuse_chain.h"
#include "echopath/replay/inner_part.h"
#include "echopath/replay/launch_cell.h"

namespace echopath {
namespace {

constexpr double kFourPi = 4.0 * kPi;

std::complex<double> coherent_factor(const LocalPath& path, const PosedHit* hits, const InnerPart& inner, const AntennaLeg& in,
                                     const AntennaLeg& out, const RadioConstants& radio) {
  const PosedHit& hit = hits[path.last_material];
  const Vec3& arrival = path.first_material == path.last_material ? in.travel : inner.last_arrival;
  const double cos_in = -hit.normal.dot(arrival), cos_out = hit.normal.dot(out.travel);
  if (cos_in * cos_out <= 0) return 0.0;
  const HitGeometry at{hit, arrival, out.travel, in.length + inner.length, out.length, std::abs(cos_in), std::abs(cos_out)};
  const double spreading = root_tube_area(path.cell, at) * out.length;
  return std::sqrt(radio.transmit_power * in.gain.power * out.gain.power) / kFourPi * at.cos_in * hit.area_ratio /
         spreading *
         cell_filter(path.cell, at, radio.filter());
}

double diffuse_factor(const LocalPath& path, const PosedHit* hits, const DiffuseInner& between, const AntennaLeg& in,
                      const AntennaLeg& out, const RadioConstants& radio) {
  const double cos_in = -hits[path.first_material].normal.dot(in.travel), cos_out = hits[path.last_material].normal.dot(out.travel);
  const double start = between.begins_specular
                           ? specular_leg(std::sqrt(in.gain.power), in.length, between.to_first, between.root_cos_first)
                           : diffuse_leg<ScalarMath>(std::sqrt(in.gain.power), cos_in, in.length);
  const double end = diffuse_leg<ScalarMath>(std::sqrt(out.gain.power), cos_out, out.length);
  const double product = between.is_single
                             ? diffuse_product<ScalarMath>(start, end)
                             : diffuse_product<ScalarMath>(start, end, between.first_sign, between.last_sign);
  return diffuse_scale(radio) * product * between.factor;
}

// What the polarisations of two antennas make of a path: receive components, matrix, transmit components.
std::complex<double> polarization_factor(const JonesMatrix& j, const PosedAntenna& start, const Vec3& departure,
                                         const PosedAntenna& end, const Vec3& arrival) {
  const Eigen::Vector2d from = transverse_components(start.polarization, departure);
  const Eigen::Vector2d to = transverse_components(end.polarization, arrival);
  return to[0] * (from[0] * std::complex<double>(j[0]) + from[1] * std::complex<double>(j[1])) +
         to[1] * (from[0] * std::complex<double>(j[2]) + from[1] * std::complex<double>(j[3]));
}

// Phase of both antennas; most have none.
void turn(std::complex<double>& amplitude, double phase) {
  if (phase != 0.0) amplitude *= std::polar(1.0, phase);
}

void evaluate_mirrors_only(const LocalPath& path, const PosedHit* hits, const Instant& instant, const RadioConstants& radio,
                           const ChannelValues& out) {
  int64_t channel = 0;
  for (const PosedAntenna& transmitter : instant.transmitters) {
    for (const PosedAntenna& receiver : instant.receivers) {
      const MirrorOnlyLeg leg = mirror_only_leg(path, hits, transmitter, receiver);
      const int64_t at = out.stride * channel++;
      out.length[at] = leg.length;
      out.amplitude[at] = path.weight * radio.wavelength *
                          std::sqrt(radio.transmit_power * leg.transmit_gain.power * leg.receive_gain.power) /
                          (kFourPi * leg.length);
      if (path.jones) {
        out.amplitude[at] *= polarization_factor(*path.jones, transmitter, leg.departure, receiver, leg.arrival);
      }
      turn(out.amplitude[at], leg.transmit_gain.phase + leg.receive_gain.phase);
    }
  }
}

PosedHit* moved_hits(const LocalPath& path, const Vec3& start, EvaluationScratch& scratch) {
  std::copy_n(scratch.hits.begin(), path.count, scratch.moved.begin());
  step_to_fermat(path, start, scratch.slide, scratch.moved.data());
  return scratch.moved.data();
}

// Channels of one antenna at the start with all at the end.
ChannelValues channels_of(const LocalPath& path, size_t start, size_t num_starts, size_t num_ends, const ChannelValues& all) {
  const size_t first = path.is_reversed ? start : start * num_ends, step = path.is_reversed ? num_starts : 1;
  const auto offset = all.stride * static_cast<int64_t>(first);
  return {all.length + offset, all.amplitude + offset, all.stride * static_cast<int64_t>(step)};
}

// From one antenna to all at the other end, whose legs are `receive`.
void evaluate_start(const LocalPath& path, const PosedHit* hits, const InnerPart& inner, const PosedAntenna& start,
                    const std::vector<PosedAntenna>& ends, const std::vector<AntennaLeg>& receive, const RadioConstants& radio,
                    const ChannelValues& out) {
  const AntennaLeg in = transmit_leg(path, hits, start);
  DiffuseInner between;
  if (path.diffuse != 0) between = diffuse_inner(path, hits, inner);
  for (size_t end = 0; end < ends.size(); ++end) {
    const AntennaLeg& back = receive[end];
    const int64_t at = out.stride * static_cast<int64_t>(end);
    out.length[at] = in.length + inner.length + back.length;
    const bool near = in.length < kNearAntenna || back.length < kNearAntenna;
    if (near) out.amplitude[at] = 0.0;
    else if (path.diffuse == 0) out.amplitude[at] = path.weight * coherent_factor(path, hits, inner, in, back, radio);
    else out.amplitude[at] = path.weight * diffuse_factor(path, hits, between, in, back, radio);
    if (path.jones) out.amplitude[at] *= polarization_factor(*path.jones, start, in.at_antenna, ends[end], back.at_antenna);
    turn(out.amplitude[at], in.gain.phase + back.gain.phase);
  }
}

}  // namespace

RadioConstants radio_constants(const Paths& paths, const Radar& radar) {
  RadioConstants radio;
  radio.transmit_power = radar.transmit_power;
  radio.wavelength = kSpeedOfLight / radar.waveform.start_frequency;
  radio.wavenumber = kTwoPi / radio.wavelength;
  radio.footprint = paths.frame.footprint;
  radio.spread = footprint_spread(paths.frame.sampler);
  return radio;
}

void evaluate_path(const LocalPath& path, const Instant& instant, const RadioConstants& radio, EvaluationScratch& scratch,
                   const ChannelValues& out) {
  PosedHit* hits = scratch.hits.data();
  pose_hits(path, instant, hits);
  if (path.first_material < 0) {
    evaluate_mirrors_only(path, hits, instant, radio, out);
    return;
  }
  const bool is_fixed = path.sliding == 0 || radio.specular == SpecularPoints::kMaterial;
  const std::vector<PosedAntenna>& starts = path.is_reversed ? instant.receivers : instant.transmitters;
  const std::vector<PosedAntenna>& ends = path.is_reversed ? instant.transmitters : instant.receivers;
  scratch.receive.clear();
  for (const PosedAntenna& antenna : ends) scratch.receive.push_back(receive_leg(path, hits, antenna));
  InnerPart inner;
  if (is_fixed) inner = inner_part(path, hits);
  for (size_t start = 0; start < starts.size(); ++start) {
    if (!is_fixed) {
      hits = moved_hits(path, starts[start].position, scratch);
      inner = inner_part(path, hits);
    }
    evaluate_start(path, hits, inner, starts[start], ends, scratch.receive, radio,
                   channels_of(path, start, starts.size(), ends.size(), out));
  }
}

}  // namespace echopath
