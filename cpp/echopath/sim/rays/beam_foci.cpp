#include "echopath/sim/rays/beam_foci.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/posed/posed_antenna.h"
#include "echopath/sim/rays/plan_foci.h"
#include "echopath/spectrum/array/steering.h"

namespace echopath {
namespace {

constexpr double kLargestPartOfStratum = 0.25;  // of its solid angle, for the cone of a focus
constexpr double kBeamShare = 0.5;              // of its rays
constexpr double kLeastInside = 0.25;           // of the beam, in the stratum
constexpr double kNarrowest = 1e-3;             // rad, the first ring of directions about the axis
constexpr int kRings = 96, kSpokes = 32;

// Returns one antenna of each look: of the same pattern and boresight, as those of an array mostly are.
std::vector<PosedAntenna> looks_of(const std::vector<Antenna>& antennas, const Transform& world_from_radar) {
  std::vector<PosedAntenna> looks;
  const std::vector<PosedAntenna> posed = posed_antennas(antennas, world_from_radar, Vec3::Zero());
  for (size_t i = 0; i < antennas.size(); ++i) {
    const auto is_alike = [&](const Antenna& before) {
      return have_one_beam(before, antennas[i]) && before.pattern.peak_gain == antennas[i].pattern.peak_gain;
    };
    if (std::ranges::none_of(std::span(antennas).first(i), is_alike)) looks.push_back(posed[i]);
  }
  return looks;
}

// Returns where the gain of an antenna is largest: its boresight, unless it has a table.
Vec3 peak_of(const PosedAntenna& antenna) {
  if (!antenna.pattern->table) return antenna.boresight;
  const GainTable& table = *antenna.pattern->table;
  const auto place = std::ranges::max_element(table.gain()) - table.gain().begin();
  const auto columns = std::ssize(table.azimuth());
  const Vec3 own = direction(table.azimuth()[place % columns], table.elevation()[place / columns]);
  return antenna.antenna_from_world.transpose() * own;
}

double mean_gain(const std::vector<PosedAntenna>& looks, const Vec3& direction) {
  double sum = 0.0;
  for (const PosedAntenna& look : looks) sum += look.toward(direction).power;
  return sum / static_cast<double>(looks.size());
}

// Returns a direction `angle` off an axis, the part `turn` of a turn about it.
Vec3 beside(const Vec3& axis, double angle, double turn) {
  const Vec3 first = axis.unitOrthogonal(), second = axis.cross(first);
  const double phase = kTwoPi * turn;
  return std::cos(angle) * axis + std::sin(angle) * (std::cos(phase) * first + std::sin(phase) * second);
}

double spoke(int index, double shift) { return (index + shift) / kSpokes; }

// Returns the part of a beam that lies in a stratum.
double part_inside(const BeamCone& beam, const Stratum& stratum) {
  constexpr int kCircles = 4;
  const double half = half_angle_of(beam.versine);
  int inside = 0;
  for (int circle = 0; circle < kCircles; ++circle) {
    const double angle = half * std::sqrt((circle + 0.5) / kCircles);  // of equal areas
    for (int i = 0; i < kSpokes; ++i) inside += stratum.contains(beside(beam.axis, angle, spoke(i, 0.0))) ? 1 : 0;
  }
  return static_cast<double>(inside) / (kCircles * kSpokes);
}

}  // namespace

BeamCone two_way_beam(const Radar& radar, const Transform& world_from_radar) {
  const auto transmitters = looks_of(radar.transmitters, world_from_radar);
  const auto receivers = looks_of(radar.receivers, world_from_radar);
  Vec3 sum = Vec3::Zero();
  for (const auto* looks : {&transmitters, &receivers})
    for (const PosedAntenna& look : *looks) sum += peak_of(look) / static_cast<double>(looks->size());
  if (sum.norm() < 1.0) return {};  // of two unit vectors: they look to different sides
  BeamCone beam{sum.normalized()};
  std::vector<double> edge = {0.0}, held = {0.0};  // rad, and what the cone up to there holds
  for (int ring = 0; ring < kRings; ++ring) {
    const double outer = kNarrowest * std::pow(kPi / kNarrowest, ring / (kRings - 1.0));
    double gain = 0.0;
    for (int i = 0; i < kSpokes; ++i) {
      const Vec3 direction = beside(beam.axis, 0.5 * (edge.back() + outer), spoke(i, 0.5 * (ring % 2)));
      gain += mean_gain(transmitters, direction) * mean_gain(receivers, direction) / kSpokes;
    }
    held.push_back(held.back() + gain * (std::cos(edge.back()) - std::cos(outer)));
    edge.push_back(outer);
  }
  const auto end = std::ranges::find_if(held, [&](double part) { return part >= kBeamPart * held.back(); });
  beam.versine = versine_of(edge[end - held.begin()]);
  return beam;
}

BeamFoci::BeamFoci(const Paths& paths)
    : paths_(paths), beam_(two_way_beam(paths.radar, paths.radar.world_from_radar(paths.frame.trace_time))) {
  focus_.axis = beam_.axis;
  focus_.versine = versine_of(std::min(half_angle_of(beam_.versine) / kFocusCore, kPi));
}

bool BeamFoci::fits(const Stratum& stratum) const {
  return kTwoPi * focus_.versine <= kLargestPartOfStratum * stratum.solid_angle() &&
         part_inside(beam_, stratum) >= kLeastInside;
}

void BeamFoci::set(LaunchGuide& guide) const {
  for (const Stratum& stratum : paths_.frame.strata) {
    const auto found = guide.shares.find(stratum.name);
    if (stratum.is_focus() || found == guide.shares.end() || !fits(stratum)) continue;
    LaunchFocus focus = focus_;
    focus.of = stratum.name;
    focus.share = rounded_rays(kBeamShare * found->second);
    found->second -= focus.share;
    guide.foci.push_back(focus);
  }
}

}  // namespace echopath
