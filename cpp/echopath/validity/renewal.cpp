#include "echopath/validity/renewal.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/replay/factors/radio_constants.h"
#include "echopath/validity/frame/frame_probe.h"
#include "echopath/validity/legs/coefficients.h"
#include "echopath/validity/legs/edge_share.h"

namespace echopath {
namespace {

constexpr int64_t kPathsRenewedTogether = 2048;
constexpr double kStaysPut = 1e-3;   // rad: points of reflection that change the length by less keep their hits
constexpr double kConverged = 1e-6;  // rad, of the length that the next Newton step would change
constexpr int kMaxNewtonSteps = 12;  // they converge quadratically; what needs more is at a caustic

enum class Purpose : uint8_t { kRenew, kLookUp };
enum class Outcome : uint8_t { kKept, kMoved, kBlocked, kOffMirror, kLost };

bool stays(Outcome outcome) { return outcome == Outcome::kKept || outcome == Outcome::kMoved; }

// Holds what has become of the field of a path that stays.
struct FieldNow {
  int64_t path = 0;
  std::optional<std::complex<double>> share;  // what edges leave of an image
  std::complex<double> gain = 1.0;            // over that of the record, of the coefficients in the weight
  std::optional<JonesMatrix> matrix;

  bool is_as_recorded() const { return !share && gain == 1.0 && !matrix; }
};

// Holds what became of a block of paths, and the hits of those that moved, in the order of the record.
struct BlockOutcome {
  std::vector<Outcome> of_path;
  std::vector<Hit> moved_hits;
  std::vector<FieldNow> fields;
};

class Renewer {
 public:
  Renewer(const Paths& paths, const Radar& radar, double time, Job* job, KeptGeometry* kept)
      : paths_(paths), radar_(one_channel(probe_radar(paths, radar))), preparer_(paths, whole_meshes(*paths.scene)),
        walk_(*paths.scene, preparer_.smooth_normals()), wavenumber_(radio_constants(paths, radar).wavenumber),
        pose_(*paths.scene, time),
        loan_(kept, *paths.scene, pose_, paths.frame.transmitter, EmbreeScene::Upkeep::kTimes, job), geometry_(*loan_),
        origin_(geometry_.origin()), scene_at_(*paths.scene, radar_, preparer_.meshes(), origin_, time),
        scene_at_trace_(*paths.scene, radar_, preparer_.meshes(), origin_, paths.frame.trace_time),
        coefficients_(paths, kSpeedOfLight / kTwoPi * wavenumber_) {}

  // Renewed paths have the fields of what stays. A look-up needs none, and finds images that a trace has as rays by now.
  BlockOutcome renew_block(std::span<const int64_t> indices, Purpose purpose) const {
    BlockOutcome block;
    const LocalPaths local = preparer_(indices);
    Scratch scratch(local.longest);
    for (size_t i = 0; i < indices.size(); ++i) {
      const LocalPath& path = local.paths[i];
      Outcome& outcome = block.of_path.emplace_back(renew_path(path, scratch, block.moved_hits));
      if (purpose == Purpose::kLookUp) {
        if (is_seen_by_rays(path, scratch.posed.data(), outcome)) outcome = Outcome::kKept;
        continue;
      }
      if (!stays(outcome)) continue;
      const FieldNow field = renew_field(indices[i], path, scratch);
      if (!field.is_as_recorded()) block.fields.push_back(field);
    }
    return block;
  }

 private:
  struct Scratch {
    std::vector<PosedHit> posed, posed_at_trace;
    std::vector<LocalHit> hits;
    std::vector<std::array<Vec3, 3>> normals;  // of hits that moved
    SpecularSlide slide;
    explicit Scratch(int longest)
        : posed(size_of(longest)), posed_at_trace(size_of(longest)), hits(size_of(longest)), normals(size_of(longest)) {}
    static size_t size_of(int longest) { return static_cast<size_t>(std::max(longest, 1)); }
  };

  Outcome renew_path(const LocalPath& recorded, Scratch& scratch, std::vector<Hit>& moved_hits) const {
    LocalPath path = recorded;
    std::copy_n(recorded.hits, recorded.count, scratch.hits.begin());
    path.hits = scratch.hits.data();
    pose_hits(path, scene_at_, scratch.posed.data());
    Outcome outcome = Outcome::kKept;
    if (path.sliding != 0) outcome = find_reflections(path, scratch);
    if (outcome == Outcome::kLost) return outcome;
    const LegShadows shadows = shadows_of(path, scratch.posed.data());
    if (shadows.blocked != 0 || shadows.is_end_blocked) return Outcome::kBlocked;
    if (shadows.off_mirror != 0) return Outcome::kOffMirror;
    if (outcome == Outcome::kMoved) append_hits(path, moved_hits);
    return outcome;
  }

  // Takes the hits as renew_path has posed them.
  FieldNow renew_field(int64_t index, const LocalPath& path, Scratch& scratch) const {
    FieldNow field;
    field.path = index;
    if (is_over_unflagged_planes(path, preparer_)) {
      const auto found =
          find_edge_share(geometry_, path, scratch.posed.data(), start_of(path), end_of(path), kTwoPi / wavenumber_);
      if (found) field.share = found->share;
    }
    // Matrices of paths through sheets hold what these make of polarisations, too: they stay.
    if (coefficients_.follow_angles(path) && (paths_.jones.empty() || paths_.passes_of(index).empty()))
      renew_coefficients(path, scratch, field);
    return field;
  }

  void renew_coefficients(const LocalPath& path, Scratch& scratch, FieldNow& field) const {
    pose_hits(path, scene_at_trace_, scratch.posed_at_trace.data());
    const PathAtTime then = at_time(path, scratch.posed_at_trace, scene_at_trace_),
                     now = at_time(path, scratch.posed, scene_at_);
    if (now.is_as(then)) return;
    if (!paths_.jones.empty()) {
      field.matrix = matrix_now(paths_.jones[field.path], coefficients_.matrix(then), coefficients_.matrix(now));
      return;
    }
    const std::complex<double> recorded = coefficients_.product(then);
    if (std::norm(recorded) > 0) field.gain = coefficients_.product(now) / recorded;
  }

  // Changes the recorded matrix by as much as the path's changes: at the rims of smooth bodies, and where axes were carried
  // from antenna to antenna, the record is not what the hits make of a wave to the last digit.
  static JonesMatrix matrix_now(JonesMatrix recorded, const JonesMatrix& then, const JonesMatrix& now) {
    for (size_t i = 0; i < recorded.size(); ++i) recorded[i] += now[i] - then[i];
    return recorded;
  }

  static PathAtTime at_time(const LocalPath& path, const std::vector<PosedHit>& posed, const PosedScene& scene) {
    return {path, posed.data(), scene.antennas(path.is_reversed).front().position,
            scene.antennas(!path.is_reversed).front().position};
  }

  const PosedAntenna& start_of(const LocalPath& path) const { return scene_at_.antennas(path.is_reversed).front(); }
  const PosedAntenna& end_of(const LocalPath& path) const { return scene_at_.antennas(!path.is_reversed).front(); }

  // Takes Newton steps from the recorded points of reflection to Fermat's.
  Outcome find_reflections(const LocalPath& path, Scratch& scratch) const {
    for (int step = 0; step < kMaxNewtonSteps; ++step) {
      if (!scratch.slide.solve(path, scratch.posed.data(), start_of(path).position)) return Outcome::kLost;
      const double phase = wavenumber_ * std::abs(scratch.slide.excess());
      if (phase < (step == 0 ? kStaysPut : kConverged)) return step == 0 ? Outcome::kKept : Outcome::kMoved;
      for (size_t i = 0; i < scratch.slide.size(); ++i) {
        if (!move_hit(scratch.slide.hit(i), scratch.slide.step(i), scratch)) return Outcome::kLost;
      }
    }
    return Outcome::kLost;
  }

  bool move_hit(int k, const Vec3& step, Scratch& scratch) const {
    LocalHit& hit = scratch.hits[k];
    const uint32_t mesh_id = hit.mesh_id;
    const PosedHit& from = scratch.posed[k];
    Vec3 point = surface_point(from, step);
    if (from.is_smooth) point += from.facet - from.point;  // without a step it is the hit itself
    const Vec3 in_mesh = scene_at_.linear(mesh_id).inverse() * (point - scene_at_.translation(mesh_id));
    const auto spot = walk_.find(mesh_id, hit.triangle_id, pose_.local_vertices(mesh_id), in_mesh);
    if (!spot) return false;
    hit = preparer_.hit(spot->hit);
    if (preparer_.find_smooth_normals(hit, scratch.normals[k])) hit.normals = &scratch.normals[k];
    pose_hit(hit, scene_at_, false, scratch.posed[k]);
    return true;
  }

  LegShadows shadows_of(const LocalPath& path, const PosedHit* hits) const {
    LegTester tester(geometry_, path, hits);
    if (path.first_material < 0) {
      tester.test_images(start_of(path).position, end_of(path).position);
    } else {
      tester.test_start(start_of(path).position);
      tester.test_inner();
      tester.test_end(end_of(path).position);
    }
    return tester.shadows();
  }

  // Returns whether a trace meets by its rays what it had met as an image, had that not left its plane: of unflagged planes
  // without an image it has the paths over all points that both antennas see from one side.
  bool is_seen_by_rays(const LocalPath& path, const PosedHit* hits, Outcome outcome) const {
    if (outcome != Outcome::kOffMirror || !is_over_unflagged_planes(path, preparer_)) return false;
    LocalPath over_points = path;
    over_points.image = 0;
    over_points.first_material = 0;
    over_points.last_material = path.count - 1;
    for (int k = 0; k < path.count; ++k) {
      const Vec3 before = k > 0 ? hits[k - 1].point : start_of(path).position;
      const Vec3 behind = k + 1 < path.count ? hits[k + 1].point : end_of(path).position;
      const auto side_of = [&](const Vec3& point) { return (point - hits[k].point).dot(hits[k].normal); };
      if (side_of(before) * side_of(behind) <= 0) return false;
    }
    const LegShadows shadows = shadows_of(over_points, hits);
    return shadows.blocked == 0 && !shadows.is_end_blocked;
  }

  static void append_hits(const LocalPath& path, std::vector<Hit>& out) {
    for (int k = 0; k < path.count; ++k) {
      const LocalHit& hit = path.hits[path.is_reversed ? path.count - 1 - k : k];
      out.push_back({hit.mesh_id, hit.triangle_id, static_cast<float>(hit.u), static_cast<float>(hit.v)});
    }
  }

  const Paths& paths_;
  Radar radar_;
  PathPreparer preparer_;
  SurfaceWalk walk_;
  double wavenumber_;
  PosedScene pose_;
  GeometryLoan loan_;
  const EmbreeScene& geometry_;
  Vec3 origin_;
  PosedScene scene_at_, scene_at_trace_;
  Coefficients coefficients_;
};

// Gives an image the share of the field that edges leave it at the time; one that has not changed stays as it is.
void set_share(std::complex<double> share, size_t path, Paths& paths) {
  uint32_t& flags = paths.flags[path];
  const std::complex<double> recorded = share_of_endless(flags);
  if (std::abs(share - recorded) < kShareRounding) return;
  paths.weight[path] *= std::complex<float>(share / recorded);
  flags &= ~(kBesideEdge | kShareBesideEdge);
  if (share != 1.0) flags |= beside_edge_flags(share);
}

// `keep` tells which of the paths of the record are in `paths`.
void set_fields(const std::vector<BlockOutcome>& blocks, const std::vector<uint8_t>& keep, Paths& paths) {
  size_t next = 0, path = 0;  // of the record, and its place in `paths`
  for (const BlockOutcome& block : blocks) {
    for (const FieldNow& field : block.fields) {
      while (next < static_cast<size_t>(field.path)) path += keep[next++];
      paths.weight[path] *= std::complex<float>(field.gain);
      if (field.matrix) paths.jones[path] = *field.matrix;
      if (field.share) set_share(*field.share, path, paths);
    }
  }
}

// Collects the paths that are still there; those that moved get hits of their own behind those of the record.
void assemble(const Paths& record, const std::vector<BlockOutcome>& blocks, Renewal& renewal, Job* job) {
  std::vector<uint8_t> keep;
  std::vector<int64_t> moved_offsets;  // of the paths that stay, -1 where they keep their hits
  auto hits = record.hits;
  std::shared_ptr<std::vector<Hit>> grown;
  for (const BlockOutcome& block : blocks) {
    int64_t next = grown ? std::ssize(*grown) : record.num_hits();
    if (!block.moved_hits.empty()) {
      if (!grown) grown = std::make_shared<std::vector<Hit>>(*record.hits);
      grown->insert(grown->end(), block.moved_hits.begin(), block.moved_hits.end());
    }
    for (const Outcome outcome : block.of_path) {
      const auto path = keep.size();
      keep.push_back(stays(outcome));
      renewal.num_blocked += outcome == Outcome::kBlocked || outcome == Outcome::kOffMirror;
      renewal.num_lost += outcome == Outcome::kLost;
      renewal.num_moved += outcome == Outcome::kMoved;
      if (!keep.back()) continue;
      moved_offsets.push_back(outcome == Outcome::kMoved ? next : -1);
      if (outcome == Outcome::kMoved) next += record.num_bounces[path];
    }
  }
  renewal.paths = record.select(keep, job);
  set_fields(blocks, keep, renewal.paths);
  if (!grown) return;
  renewal.paths.hits = grown;
  for (size_t i = 0; i < moved_offsets.size(); ++i) {
    if (moved_offsets[i] >= 0) renewal.paths.offsets[i] = moved_offsets[i];
  }
}

std::vector<BlockOutcome> renew_blocks(const Paths& paths, const Radar& radar, double time, Purpose purpose, Job* job,
                                       KeptGeometry* kept) {
  const Renewer renewer(paths, radar, time, job, kept);
  std::vector<BlockOutcome> blocks(num_chunks(paths.num_paths(), kPathsRenewedTogether));
  if (job) job->start(std::ssize(blocks));
  parallel_for_chunks(paths.num_paths(), kPathsRenewedTogether, [&](int64_t begin, int64_t end) {
    std::vector<int64_t> indices(end - begin);
    std::iota(indices.begin(), indices.end(), begin);
    blocks[begin / kPathsRenewedTogether] = renewer.renew_block(indices, purpose);
  }, job);
  return blocks;
}

}  // namespace

Renewal renew(const Paths& paths, const Radar& radar, double time, Job* job, KeptGeometry* kept) {
  Renewal renewal;
  assemble(paths, renew_blocks(paths, radar, time, Purpose::kRenew, job, kept), renewal, job);
  return renewal;
}

std::vector<uint8_t> still_there(const Paths& paths, const Radar& radar, double time, Job* job, KeptGeometry* kept) {
  std::vector<uint8_t> out;
  for (const BlockOutcome& block : renew_blocks(paths, radar, time, Purpose::kLookUp, job, kept)) {
    std::ranges::transform(block.of_path, std::back_inserter(out), stays);
  }
  return out;
}

}  // namespace echopath
