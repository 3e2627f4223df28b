#pragma once
// Holds what one block of rays records, until it becomes a part of the record (record_writer.h).
#include <algorithm>
#include <vector>

#include "echopath/record/blocks/path_columns.h"
#include "echopath/record/blocks/path_fan.h"

namespace echopath {

// Collects the paths of one block of rays.
class PathBlock {
 public:
  std::vector<Hit> hits;
  PathColumns rows;                  // the paths that are not of fans
  uint8_t current_batch = kNoBatch;  // of the paths added from now on
  uint32_t current_ray = 0;          // flags of the same paths: kSecondHalf, place_flags
  // This column has a row for each path up to the last one that ends behind a curved bounce; rows of other paths are zeros.
  std::vector<std::array<float, 7>> curved_cell;
  std::vector<JonesMatrix> jones;      // has a row for each path up to the last polarised one, likewise
  std::vector<JonesMatrix> fan_jones;  // of all paths of all fans, where polarised
  TraceStatistics statistics;
  std::vector<PathFan> fans;
  std::vector<FanLeg> fan_legs;  // of each fan in turn
  std::vector<Hit> fan_hits;     // of their mirrors
  // Names the first hits of a ray that passes the receiver so closely that images are looked for on the planes of these hits
  // (trace/mirrors/plane_images.h). The chains of one ray share their hits.
  struct HitChain {
    uint32_t first = 0, count = 0;  // in chain_hits
  };
  std::vector<Hit> chain_hits;
  std::vector<HitChain> chains;
  // Names the hits of a ray over planes that reflect it to the last of them (trace/edges/lit_planes.h), and holds the
  // distance in m to the rays beside it on that surface.
  struct LitChain : HitChain {
    float spacing = 0.0f;
  };
  std::vector<LitChain> lit_chains;

  // Adds a path with hits of its own.
  void add(const Hit* first, int count, uint64_t diffuse_bits, std::complex<float> path_weight, int path_stratum);
  // Adds a path over the first `count` hits of the current ray, which all such paths share.
  void add_prefix(int count, uint64_t diffuse_bits, std::complex<float> path_weight, int path_stratum) {
    used_depth_ = std::max(used_depth_, count);
    add_record(kOfRay, count, diffuse_bits, path_weight, path_stratum);
  }
  // Adds a path over `first` [count], given in the order in which it was traced, that runs the other way (kReversedPath).
  void add_reversal(const Hit* first, int count, uint64_t diffuse_bits, std::complex<float> path_weight, int path_stratum);
  // Begins a fan: paths over `hit` and every pair of the legs that are added next, first those in and then those out, except
  // pairs of more than `max_bounces` hits. `end_fan` ends it.
  void begin_fan(const Hit& hit, int stratum, int max_bounces);
  void add_leg_in(std::complex<double> factor) {
    ++fans.back().num_in;
    add_leg(factor);
  }
  void add_leg_out(std::complex<double> factor) {
    ++fans.back().num_out;
    add_leg(factor);
  }
  // Adds the next hit of the leg added last, in order of travel.
  void add_leg_hit(const Hit& hit);
  // Adds a chain of the first `count` hits of the current ray.
  void add_chain(int count) { chains.push_back({0, static_cast<uint32_t>(count)}); }
  // Adds the first `count` hits of the current ray as planes that light the last of them.
  void add_lit_chain(int count, double spacing) {
    lit_chains.push_back({{0, static_cast<uint32_t>(count)}, static_cast<float>(spacing)});
  }
  // Adds the matrix of the next pair of a polarised fan, by way in and then by way out.
  void add_pair_jones(const JonesMatrix& matrix) { fan_jones.push_back(matrix); }
  void end_fan();
  // Marks the last path added as one with an edge, or several (edge_flags in paths.h).
  void set_edge(int hit, int num_pieces, int num_edges = 1) {
    rows.flags[rows.size() - 1] |= edge_flags(hit, num_pieces, num_edges);
  }
  // Give the last path added its matrix (Paths::jones) or a launch cell of its own (Paths::curved_cell).
  void set_jones(const JonesMatrix& matrix);
  void set_curved_cell(const std::array<float, 7>& cell);
  // Stores the hits of the current ray as far as its paths use them.
  void end_ray(const Hit* ray_hits) {
    const auto base = std::ssize(hits);
    for (int k = 0; k < used_depth_; ++k) hits.push_back(ray_hits[k]);
    for (size_t i = first_of_ray_; i < rows.size(); ++i) {
      if (rows.offset[i] == kOfRay) rows.offset[i] = base;
    }
    first_of_ray_ = rows.size();
    used_depth_ = 0;
    if (first_chain_of_ray_ < chains.size() || first_lit_chain_of_ray_ < lit_chains.size()) end_chains(ray_hits);
  }
  // These return the size of the record that this block becomes.
  size_t num_paths() const { return rows.size() + num_fan_paths_; }
  size_t num_hits() const { return hits.size() + num_fan_hits_; }
  // Writes all paths in the order in which they were added. `paths` must have the optional columns that this block has.
  void write(PathRows to, Paths& paths) const;
  // Forgets everything but keeps the memory.
  void clear();

 private:
  void add_leg(std::complex<double> factor);
  void end_chains(const Hit* ray_hits);
  void write_own(size_t begin, size_t end, int64_t first_hit, size_t row, PathRows& to, Paths& paths) const;
  static constexpr int64_t kOfRay = -1;
  void add_record(int64_t offset, int count, uint64_t diffuse_bits, std::complex<float> path_weight, int path_stratum) {
    rows.add({offset, diffuse_bits, path_weight, current_ray, static_cast<uint16_t>(path_stratum),
              static_cast<uint8_t>(count), current_batch});
  }

  size_t first_of_ray_ = 0;                                     // first path of the current ray
  size_t first_chain_of_ray_ = 0, first_lit_chain_of_ray_ = 0;  // likewise
  int used_depth_ = 0;  // hits of the ray that such paths use; the offset of these paths is kOfRay until the ray ends
  size_t num_fan_paths_ = 0, num_fan_hits_ = 0;
};

}  // namespace echopath
