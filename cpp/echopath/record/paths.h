#pragma once
// Holds the record of a trace: what every ray touched. It is immutable after the trace; selections share the hits.
#include <array>
#include <bit>
#include <compare>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/em/footprint_formula.h"
#include "echopath/em/polarization/jones.h"
#include "echopath/radar/radar.h"
#include "echopath/record/sampler.h"
#include "echopath/record/scatterers.h"
#include "echopath/record/stratum.h"
#include "echopath/scene/scene.h"

namespace echopath {

struct Hit {  // 16 bytes
  uint32_t mesh_id;
  uint32_t triangle_id;
  float u, v;

  Hit() {}  // not set: so that an array of hits is made without touching its memory
  Hit(uint32_t mesh, uint32_t triangle, float first, float second)
      : mesh_id(mesh), triangle_id(triangle), u(first), v(second) {}
};
static_assert(sizeof(Hit) == 16);

// Names a triangle among all of a scene.
struct TriangleName {
  uint32_t mesh_id, triangle_id;
  auto operator<=>(const TriangleName&) const = default;
};

// Names where a path goes through a sheet (Material::layers), which is no bounce.
struct Pass {    // 20 bytes
  Hit hit;       // at the trace; the point of passing is met anew at other times and for other antennas
  uint32_t leg;  // of the path on which it lies: leg k ends at hit k, the last one at the receiver
};

// Marks paths that rays did not find (image method) and that have no stratum.
inline constexpr uint16_t kNoStratum = 65535;

// Marks paths that rays did not find (image method): they count in full in the estimate of each batch.
inline constexpr uint8_t kNoBatch = 255;

// Marks a path that was traced from its receiver's end. Its hits stand in travel order, and its amplitude is that of the
// path as it was traced with the antennas exchanged. A chain of several diffuse hits has the coefficients of its travel
// order.
inline constexpr uint32_t kReversedPath = 1;
// Marks the paths of every other ray (half_of_ray): the rays have two halves, each evenly spread over the launch directions.
// Paths of the image method belong to neither, whatever their flag.
inline constexpr uint32_t kSecondHalf = 2;
// Marks a path with a point on a sharp edge (scene/edges/sharp_edges.h), one of its hits. Its flags also hold which hit that
// is and into how many pieces of one length the edge is parted: the path stands for the piece around its point. All its
// other hits are images. Its weight holds the coefficients of the scalar model and what the faces keep in phase. A path may
// go on from edge to edge over flat faces (em/edges/multiple_diffraction.h): then its next hits, up to kMostEdges in all,
// lie on edges too, and the pieces are those of the first edge.
inline constexpr uint32_t kEdgePath = 4;
// Marks, beside that, a path whose edge sends the field of the uniform theory of diffraction to a mirror
// (em/edges/edge_shadow.h).
inline constexpr uint32_t kPastEdge = 32;
// Marks a diffuse path that counts for others, too, which were left out by lot (power/faint_paths.h).
inline constexpr uint32_t kStandsForOthers = 64;
// Marks an image over planes that nobody flagged of which one ends within 16 half zones of the point of reflection
// (trace/mirrors/mirror_zone.h). Its flags also hold the share that the edges leave of the field of endless planes,
// which is a factor of its weight: the size in 1/1024, at least one of them, and the phase in 1/4096 of a turn.
inline constexpr uint32_t kBesideEdge = 128, kShareBesideEdge = 0xffffff00u;
uint32_t beside_edge_flags(std::complex<double> share);
// Returns that share to kShareRounding, and 1 for other paths.
std::complex<double> share_of_endless(uint32_t flags);
inline constexpr double kShareRounding = 2e-3;
inline constexpr int kMostPieces = 65535, kMostEdges = 4;
constexpr uint32_t edge_flags(int hit, int num_pieces, int num_edges) {
  return kEdgePath | static_cast<uint32_t>(num_edges - 1) << 3 | static_cast<uint32_t>(hit) << 8 |
         static_cast<uint32_t>(num_pieces) << 16;
}
// These return, from the flags of a path, its first hit on an edge (-1 where there is none), the number of such hits, and
// the number of pieces of the edge.
constexpr int edge_hit(uint32_t flags) { return flags & kEdgePath ? static_cast<int>(flags >> 8 & 63u) : -1; }
constexpr int num_edge_hits(uint32_t flags) { return flags & kEdgePath ? static_cast<int>(flags >> 3 & 3u) + 1 : 0; }
constexpr int num_edge_pieces(uint32_t flags) { return static_cast<int>(flags >> 16); }
// Paths of rays that leave along the rows of the launch lattice hold, in the place of a hit on an edge, the place of the ray
// in its row: from 1 to kPlacesInRow and then again from 1. Rays at neighbouring places are neighbours in the lattice. 0
// stands for other rays.
inline constexpr int kPlacesInRow = 63;
constexpr uint32_t place_flags(int64_t index) { return static_cast<uint32_t>(index % kPlacesInRow + 1) << 8; }
constexpr int place_in_row(uint32_t flags) {
  return flags & (kEdgePath | kBesideEdge) ? 0 : static_cast<int>(flags >> 8 & 63u);
}
// Returns the flag of a ray's paths by its index: 0 or kSecondHalf. It is the parity of the index's digits (Thue and Morse),
// so that both halves of any few rays in a row have as many of them, and no digit of the nets that rays share tells them
// apart.
inline constexpr uint32_t half_of_ray(int64_t index) {
  return std::popcount(static_cast<uint64_t>(index)) % 2 == 0 ? 0 : kSecondHalf;
}

struct TraceStatistics {
  int64_t num_rays = 0;           // launched
  int64_t num_queries = 0;        // closest-hit and shadow queries
  int64_t num_hits = 0;           // surface points found
  int64_t num_paths = 0;          // recorded; selections have fewer
  int64_t num_near_antenna = 0;   // contributions dropped because an antenna lay within 1 mm
  int64_t num_grazing = 0;        // hits dropped, cos of incidence below 1e-3
  int64_t num_small_mirrors = 0;  // rays without a field ended behind an unflagged mirror of less than half its Fresnel zone
  int64_t num_false_hits = 0;     // Embree hits that double precision did not confirm
  int64_t num_unaimed = 0;        // objects and images that no rays aim at, because there are too many of them
  int64_t num_unfollowed_frusta = 0;  // sequences of mirrors whose further mirrors were not looked for (kMaxFrusta)
  int64_t num_unsplit_rays = 0;       // rays that only went on at a sheet, because they had split at too many before
  int64_t num_stopped_passes = 0;     // legs of paths that are taken to end at a sheet, behind kMostPasses others
  int64_t num_faint_paths = 0;        // left out by lot: others count for them (RecordSettings::faint_power)

  void add(const TraceStatistics& of_part);
};

// Holds the settings of a trace on which the record depends, besides the number of rays. CONTRIBUTING.md has the way of a
// setting from Python to here.
struct RecordSettings {
  uint64_t seed = 1;
  int max_bounces = 4;  // 1 to 64; hits on mirrors count
  PolarizationModel polarization = PolarizationModel::kScalar;
  Footprint footprint = Footprint::kSecondOrder;  // filter of the ray's footprint on coherent echoes, applied in replay
  Sampler sampler = Sampler::kLattice;            // of the launch directions
  // This is the number of independent lattices that share the rays, 1 to 64; errors follow from their differences. Each is
  // as fine as its share of the rays.
  int batches = 1;
  Scatterers scatterers = Scatterers::kRays;
  bool edges = false;        // also find the echoes of sharp edges (trace/edges/edge_paths.h)
  double attenuation = 0.0;  // Np/m, of fields in the air at the radar's frequency; replay applies it to each whole length
  // W, of diffuse paths, below which some are kept for all of them. Rays find all of them: it acts behind the trace
  // (power/faint_paths.h). 0 keeps all.
  double faint_power = 0.0;

  bool operator==(const RecordSettings&) const = default;
};

// Holds the values to which a path's amplitude and length refer.
struct TraceFrame : RecordSettings {
  double start_time = 0.0;                                   // s, first sample of the frame
  double trace_time = 0.0;                                   // s, the time the rays saw the scene at (mid-frame)
  Vec3 transmitter = Vec3::Zero(), receiver = Vec3::Zero();  // world, mean positions at trace_time
  std::vector<Stratum> strata;
  TraceStatistics statistics;
  double target_error_db = 0.0;  // dB, the error of the received power that was asked for; 0: none
  double error_db = 0.0;         // dB, the one that was reached (sim/rays/trace_to_error.h); 0: not looked at
  // s, when objects are told from what surrounds the antenna (label/objects/surfaces.h): that of the first frame of a
  // sequence, so that all of its frames have the same objects; none: trace_time.
  std::optional<double> objects_time = std::nullopt;

  bool operator==(const TraceFrame&) const = delete;  // that of the settings alone would stand for it

  // Returns the rays per sr of one batch of a stratum, from which its launch cells are made. Filters for the cells of all
  // batches together would leave each batch its aliases, which do not cancel, because the lattices are independent of each
  // other.
  double lattice_density(size_t stratum_index) const { return strata[stratum_index].ray_density / batches; }
};

struct Paths {
  // [H], shared by all selections of one trace
  std::shared_ptr<const std::vector<Hit>> hits;
  // [P] each. `offsets` has the index of the path's first hit; its hits are num_bounces consecutive ones, in travel order TX
  // -> RX.
  std::vector<int64_t> offsets;
  std::vector<uint8_t> num_bounces;
  std::vector<uint64_t> diffuse;            // bit k: hit k is diffuse; 0: the path is coherent
  std::vector<std::complex<float>> weight;  // what neither motion nor antennas change (see replay/kernels/path_formula.h)
  std::vector<uint16_t> stratum;            // index into frame.strata; kNoStratum: none (image method)
  std::vector<uint8_t> batch;               // index of the batch of rays; 255: all of them (image method)
  // bits: kReversedPath, kSecondHalf with place_flags, kStandsForOthers, kBesideEdge with beside_edge_flags, kEdgePath with
  // edge_flags
  std::vector<uint32_t> flags;
  // [P, 7] or empty: the launch cell behind curved specular bounces, at the physical-optics hit. T1 and T2 are in units of
  // the triangle's edges (du1, dv1, du2, dv2), then T_a.U_b in m (11, 12, 22). A flat chain has zeros.
  std::vector<std::array<float, 7>> curved_cell;

  // [P] or empty (scalar). Matrices are in the transverse bases of em/polarization/jones.h and hold the coefficients of all
  // hits, which then are not in the weight. Those of coherent paths are divided by cos_i at the last surface.
  std::vector<JonesMatrix> jones;

  // These are the sheets through which paths go, in order of travel, path by path: those of path p are [pass_offsets[p],
  // pass_offsets[p + 1]). Both are empty where no path goes through any.
  std::vector<Pass> passes;
  std::vector<int64_t> pass_offsets;  // [P + 1] or empty

  std::shared_ptr<const Scene> scene;  // snapshot
  Radar radar;                         // snapshot
  TraceFrame frame;

  int64_t num_paths() const { return std::ssize(offsets); }
  int64_t num_hits() const { return hits ? std::ssize(*hits) : 0; }
  const Hit* hits_of(int64_t path) const { return hits->data() + offsets[path]; }
  bool is_reversed(size_t path) const { return (flags[path] & kReversedPath) != 0; }
  // Returns whether a ray found the path; its amplitude, where it is coherent, then is that of the ray's launch cell.
  bool is_of_a_ray(size_t path) const { return stratum[path] != kNoStratum; }
  // Returns whether the image method found the path, over planes alone: no ray did, and no edge turns it aside.
  bool is_over_images_alone(size_t path) const { return !is_of_a_ray(path) && !(flags[path] & kEdgePath); }
  bool is_coherent_with_cell(size_t path) const { return diffuse[path] == 0 && is_of_a_ray(path); }
  // Returns the launch cell that the path brings along, behind curved bounces, or null: then it follows from its stratum.
  const std::array<float, 7>* curved_cell_of(size_t path) const {
    return curved_cell.empty() || curved_cell[path] == std::array<float, 7>{} ? nullptr : &curved_cell[path];
  }

  // Returns the polarisation in the world by which the scalar model and the legs between hits tell modes apart: that of the
  // first transmitter at the time of the trace.
  Vec3 mode_polarization() const;

  std::span<const Pass> passes_of(size_t path) const {
    if (pass_offsets.empty()) return {};
    const auto first = static_cast<size_t>(pass_offsets[path]), end = static_cast<size_t>(pass_offsets[path + 1]);
    return {passes.data() + first, end - first};
  }

  // Raises invalid_argument when array sizes differ, an index leads nowhere (hit, mesh, triangle, stratum, batch, edge), a
  // number is not finite, a hit lies off its triangle, or bits and flags are those of no path; validate_path looks at the
  // columns of one path alone.
  void validate() const;
  void validate_path(size_t path) const;
  // Returns the paths where keep [P] is not 0, in order; it shares the hits. Raises Cancelled when the job is cancelled.
  Paths select(const std::vector<uint8_t>& keep, Job* job = nullptr) const;
  // Returns the same paths with only the hits that they use, in their order; hits that paths share stay shared.
  Paths with_own_hits(Job* job) const;
};

// Calls visit(column) for each column that has an entry for every path, as a pointer to the member.
template <class Visit>
void for_each_column(const Visit& visit) {
  const auto visit_all = [&](auto... columns) { (visit(columns), ...); };
  visit_all(&Paths::offsets, &Paths::num_bounces, &Paths::diffuse, &Paths::weight, &Paths::stratum, &Paths::batch,
            &Paths::flags);
}

}  // namespace echopath
