#include "echopath/validity/frame/frame_probe.h"

#include <cmath>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/em/surface/surface_response.h"
#include "echopath/validity/array_corners.h"
#include "echopath/validity/legs/edge_share.h"

namespace echopath {
namespace {

constexpr double kConfirmed = 0.03;  // rad: a step beyond the triangles around a hit counts where it leaves no more
constexpr double kMostRest = 1.0;    // rad: a step that leaves more has not come near the point of reflection
constexpr double kTurned = 2.0;      // factor
constexpr double kOnePlace = 1e-9;   // m
constexpr double kSameCosine = 1e-9;
constexpr double kOtherField = 0.3;  // of the larger of two coefficients, as kEdgeLimit of fields

// Returns the bits of hits in the order of the record.
uint64_t recorded_order(const LocalPath& path, uint64_t bits) {
  if (!path.is_reversed) return bits;
  uint64_t out = 0;
  for (int k = 0; k < path.count; ++k) out |= (bits >> k & 1) << (path.count - 1 - k);
  return out;
}

// In the other direction the same leg arrives at the other of its ends.
void store_shadows(const LocalPath& path, const LegShadows& shadows, PathState& state) {
  state.left |= recorded_order(path, shadows.off_mirror);
  if (!path.is_reversed) {
    state.blocked = shadows.blocked;
    state.is_receiver_blocked = shadows.is_end_blocked;
    return;
  }
  state.is_receiver_blocked = shadows.blocked & 1;
  state.blocked = recorded_order(path, shadows.blocked >> 1 | uint64_t{shadows.is_end_blocked} << (path.count - 1));
}

// Tells which legs of a path are meant.
enum class Part : uint64_t { kStart, kInner, kEnd };
struct Run {
  int first, last;  // hits, in the order of the trace
  Part part;
};

constexpr int kMostHits = 58;  // of a run, whose events then fit into its kind

// Returns all on which the legs of a run depend but the hits themselves: the order in which they are passed, and for inner
// legs which of the hits are images.
uint64_t kind_of(const LocalPath& path, const Run& run) {
  const uint64_t events =
      run.part == Part::kInner ? path.diffuse >> run.first & ((uint64_t{1} << (run.last - run.first + 1)) - 1) : 0;
  return static_cast<uint64_t>(run.part) | uint64_t{path.is_reversed} << 2 | events << 3;
}

LegShadows shifted(const LegShadows& shadows, int by) {
  const auto shift = [by](uint64_t bits) { return by < 0 ? bits >> -by : bits << by; };
  return {shift(shadows.blocked), shadows.is_end_blocked, shift(shadows.off_mirror)};
}

// Bits are kept as if the run began with hit 0, because it may stand anywhere in the next path.
template <class Find>
LegShadows known_part(const LocalPath& path, const Run& run, LegMemo& known, Find find) {
  const int count = run.last - run.first + 1;
  if (count > kMostHits) return find();
  const Hit* hits = path.recorded + (path.is_reversed ? path.count - 1 - run.last : run.first);
  return shifted(known(hits, count, kind_of(path, run), [&] { return shifted(find(), -run.first); }), run.first);
}

// Returns the antenna that a trace has, then those at the rim of the array, and one for each other beam.
std::vector<Antenna> carried_and_rim(const Vec3& carried, const std::vector<Antenna>& antennas) {
  std::vector<Antenna> out = {antennas[0]};
  out[0].position = carried;
  if (antennas.size() == 1 && (antennas[0].position - carried).norm() > kOnePlace) out.push_back(antennas[0]);
  for (const int corner : array_corners(antennas)) out.push_back(antennas[corner]);
  for (const Antenna& antenna : antennas) {
    const auto is_alike = [&](const Antenna& other) { return have_one_beam(antenna, other); };
    if (std::none_of(out.begin(), out.end(), is_alike)) out.push_back(antenna);
  }
  return out;
}

// Writes the signed cosines of incidence and departure [2 * hits]; images keep theirs, and edges, whose faces count as
// little by themselves.
void fill_cosines(const LocalPath& path, const PosedHit* hits, const Vec3& start, const Vec3& end,
                  std::vector<double>& out) {
  if (path.edge >= 0) return;
  for_each_hit(path, hits, start, end, [&](int k, const Vec3& arrival, const Vec3& departure) {
    if (path.is_image(k)) return;
    out[2 * k] = -hits[k].normal.dot(arrival);
    out[2 * k + 1] = hits[k].normal.dot(departure);
  });
}

// Writes the cosines of incidence of a wave that meets all hits of a path as images, in those places of [2 * hits].
void fill_image_cosines(const LocalPath& path, const PosedHit* hits, const Vec3& start, const Vec3& end,
                        std::vector<double>& out) {
  for_each_hit(path, hits, start, end, [&](int k, const Vec3& arrival, const Vec3&) {
    out[2 * k] = std::min(1.0, std::abs(arrival.dot(hits[k].normal)));
  });
}

// Returns by how much the coefficients of both modes differ between two cosines of incidence, over the larger of them.
double coefficient_change(const Material& material, double frequency, double before, double now) {
  if (material.conductor || std::abs(now - before) < kSameCosine) return 0.0;
  double change = 0.0, sizes[2] = {};
  for (const PolarizationMode mode : {PolarizationMode::kTe, PolarizationMode::kTm}) {
    const std::complex<double> there = respond(material, frequency, before, mode).gamma;
    const std::complex<double> here = respond(material, frequency, now, mode).gamma;
    change += std::norm(here - there);
    sizes[0] += std::norm(there);
    sizes[1] += std::norm(here);
  }
  const double largest = std::max(sizes[0], sizes[1]);
  return largest > 0.0 ? std::sqrt(change / largest) : 0.0;
}

}  // namespace

Radar probe_radar(const Paths& paths, const Radar& radar) {
  const Transform radar_from_world = paths.radar.world_from_radar(paths.frame.trace_time).inverse();
  Radar probe = radar;
  probe.transmitters = carried_and_rim(radar_from_world * paths.frame.transmitter, radar.transmitters);
  probe.receivers = carried_and_rim(radar_from_world * paths.frame.receiver, radar.receivers);
  return probe;
}

PathState FrameProbe::check(const LocalPath& path, ProbeScratch& scratch, LegMemo& known) const {
  PathState state;
  pose_hits(path, rim_, scratch.hits.data());
  if (path.sliding != 0) check_slides(path, scratch, state);
  const PosedHit* hits = scratch.hits.data();
  store_shadows(path, path.first_material < 0 ? shadows_of_images(path, hits) : shadows_of(path, hits, known), state);
  check_cosines(path, scratch, state);
  if (is_over_unflagged_planes(path, preparer_)) check_edges(path, hits, state);
  return state;
}

// Holds what one antenna sees of the points of reflection.
struct FrameProbe::Slides {
  uint64_t left = 0;                   // bits in the order of the trace
  double frozen = 0.0, stepped = 0.0;  // m, errors of the length
};

FrameProbe::Slides FrameProbe::slides_from(const LocalPath& path, const Vec3& start, ProbeScratch& scratch) const {
  Slides found;
  if (!scratch.slide.solve(path, scratch.hits.data(), start)) {
    found.left = path.sliding;
    return found;
  }
  const uint64_t far = find_stepped(path, scratch, found.left);
  if (found.left) return found;
  const bool is_solved = scratch.check.solve(path, scratch.found.data(), start);
  const double rest = scratch.check.excess(), length = scratch.check.length() - rest;
  const double rest_phase = wavenumber_ * std::abs(rest);
  if (!is_solved || rest_phase > kMostRest) found.left = path.sliding;
  else if (rest_phase > kConfirmed) found.left = far;
  found.frozen = std::abs(scratch.slide.length() - length);
  scratch.check.solve(path, scratch.stepped.data(), start);
  found.stepped = std::abs(scratch.check.length() - length);
  return found;
}

// Fills scratch.stepped with hits one Newton step farther and scratch.found with what the meshes have there; sets the bits
// of hits that have left their surface. Returns the bits of those that lie beyond the triangles around their hit.
uint64_t FrameProbe::find_stepped(const LocalPath& path, ProbeScratch& scratch, uint64_t& left) const {
  std::copy_n(scratch.hits.begin(), path.count, scratch.stepped.begin());
  std::copy_n(scratch.hits.begin(), path.count, scratch.found.begin());
  uint64_t far = 0;
  for (size_t i = 0; i < scratch.slide.size(); ++i) {
    const auto k = static_cast<size_t>(scratch.slide.hit(i));
    bool is_near = true;
    scratch.stepped[k].point = surface_point(scratch.hits[k], scratch.slide.step(i));
    if (!move_hit(path.hits[k], scratch.stepped[k].point, scratch.found[k], is_near)) left |= uint64_t{1} << k;
    if (!is_near) far |= uint64_t{1} << k;
  }
  return far;
}

// Poses the point of the hit's mesh over which `point` lies; returns false where the way there leaves the surface.
bool FrameProbe::move_hit(const LocalHit& hit, const Vec3& point, PosedHit& out, bool& is_near) const {
  const Vec3 in_mesh = rim_.linear(hit.mesh_id).inverse() * (point - rim_.translation(hit.mesh_id));
  const auto spot = walk_.find(hit.mesh_id, hit.triangle_id, pose_.local_vertices(hit.mesh_id), in_mesh);
  if (!spot) return false;
  is_near = spot->is_near;
  LocalHit moved = preparer_.hit(spot->hit);
  std::array<Vec3, 3> normals;
  if (hit.normals && preparer_.find_smooth_normals(moved, normals)) moved.normals = &normals;
  pose_hit(moved, rim_, false, out);
  return true;
}

void FrameProbe::check_slides(const LocalPath& path, ProbeScratch& scratch, PathState& state) const {
  uint64_t left = 0;
  for (const PosedAntenna& start : starts(path)) {
    const Slides found = slides_from(path, start.position, scratch);
    left |= found.left;
    if (found.left) continue;
    const bool is_own = &start == &starts(path).front();
    for (auto [error, value] : {std::pair(&state.frozen, found.frozen), std::pair(&state.stepped, found.stepped)}) {
      if (is_own) error->motion = value;
      error->largest = std::max(error->largest, value);
    }
  }
  state.left = recorded_order(path, left);
}

LegShadows FrameProbe::shadows_of_images(const LocalPath& path, const PosedHit* hits) const {
  LegTester tester(geometry_, path, hits);
  for (const PosedAntenna& start : starts(path)) {
    for (const PosedAntenna& end : ends(path)) tester.test_images(start.position, end.position);
  }
  return tester.shadows();
}

// Tests the legs before, between and behind the material points; the result of each part follows from its own hits.
LegShadows FrameProbe::shadows_of(const LocalPath& path, const PosedHit* hits, LegMemo& known) const {
  const int first = path.first_material, last = path.last_material;
  LegShadows all;
  all.add(known_part(path, {0, first, Part::kStart}, known, [&] {
    LegTester tester(geometry_, path, hits);
    for (const PosedAntenna& start : starts(path)) tester.test_start(start.position);
    return tester.shadows();
  }));
  all.add(known_part(path, {last, path.count - 1, Part::kEnd}, known, [&] {
    LegTester tester(geometry_, path, hits);
    for (const PosedAntenna& end : ends(path)) tester.test_end(end.position);
    return tester.shadows();
  }));
  if (first == last) return all;
  all.add(known_part(path, {first, last, Part::kInner}, known, [&] {
    LegTester tester(geometry_, path, hits);
    tester.test_inner();
    return tester.shadows();
  }));
  return all;
}

void FrameProbe::cosines(const LocalPath& path, ProbeScratch& scratch, std::vector<double>& out) const {
  out.assign(2 * path.count, 0.0);
  const bool has_images_alone = path.first_material < 0;
  pose_hits(path, rim_, scratch.hits.data());
  const auto fill = has_images_alone ? fill_image_cosines : fill_cosines;
  fill(path, scratch.hits.data(), starts(path).front().position, ends(path).front().position, out);
}

// The cosines at an end change with its own antenna only.
void FrameProbe::check_cosines(const LocalPath& path, ProbeScratch& scratch, PathState& state) const {
  if (path.first_material < 0) return check_coefficients(path, scratch, state);
  scratch.cosines.assign(2 * path.count, 0.0);
  for_antennas_in_turn(path, [&](const PosedAntenna& start, const PosedAntenna& end) {
    fill_cosines(path, scratch.hits.data(), start.position, end.position, scratch.cosines);
    for (size_t k = 0; k < scratch.cosines.size(); ++k) {
      const double before = scratch.reference[k], now = scratch.cosines[k];
      state.cosine_change = std::max(state.cosine_change, std::abs(now - before));
      if (before != 0 && !(now / before > 1.0 / kTurned && now / before < kTurned)) state.is_turned = true;
    }
  });
}

// A record keeps the coefficients of its own antennas at the trace time.
void FrameProbe::check_coefficients(const LocalPath& path, ProbeScratch& scratch, PathState& state) const {
  const double frequency = wavenumber_ * kSpeedOfLight / kTwoPi;
  scratch.cosines.assign(2 * path.count, 0.0);
  for_antennas_in_turn(path, [&](const PosedAntenna& start, const PosedAntenna& end) {
    fill_image_cosines(path, scratch.hits.data(), start.position, end.position, scratch.cosines);
    for (int k = 0; k < path.count; ++k) {
      const Material& material = *preparer_.paths().scene->node_of(path.hits[k].mesh_id).material;
      const double before = scratch.reference[2 * k], now = scratch.cosines[2 * k];
      if (coefficient_change(material, frequency, before, now) > kOtherField) state.is_turned = true;
    }
  });
}

// Antennas that do not see the image are those of LegShadows.
void FrameProbe::check_edges(const LocalPath& path, const PosedHit* hits, PathState& state) const {
  const std::complex<double> recorded = share_of_endless(path.flags);
  bool is_next_own = true;  // the trace's antennas come first
  for_antennas_in_turn(path, [&](const PosedAntenna& start, const PosedAntenna& end) {
    const bool is_own = std::exchange(is_next_own, false);
    const auto found = find_edge_share(geometry_, path, hits, start, end, kTwoPi / wavenumber_);
    if (!found) return;
    const double largest = std::max(std::abs(found->share), std::abs(recorded));
    state.edge_change = std::max(state.edge_change, std::abs(found->share - recorded) / largest);
    state.edge_slide = std::max(state.edge_slide, found->slide);
    if (is_own) state.edge_ratio = found->share / recorded;
  });
}

}  // namespace echopath
