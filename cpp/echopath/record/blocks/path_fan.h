#pragma once
// Stores all paths over one diffuse hit in a compact form. Each leg by which the wave comes to the hit forms a path with
// each leg by which it leaves. A fan keeps the two lists of legs; the paths, one for each pair, are written when the record
// is put together.
#include <complex>
#include <cstdint>
#include <vector>

#include "echopath/record/paths.h"

namespace echopath {

// Describes a leg between an antenna and the hit of a fan, directly or over mirrors.
struct FanLeg {
  std::complex<float> factor;  // of the path's weight
  uint32_t first_hit = 0;      // of its mirrors, in order of travel
  uint32_t num_hits = 0;
};

// Describes the hit of a fan and counts its legs.
struct PathFan {
  size_t num_before = 0;  // paths of the block in front of it, without those of fans
  Hit hit;
  uint16_t stratum = 0;
  uint8_t batch = 0;
  uint32_t flags = 0;
  uint32_t num_in = 0, num_out = 0, max_bounces = 0;

  // Returns whether the path of a pair of legs has few enough hits; the arguments count the hits of their mirrors.
  bool fits(uint32_t hits_in, uint32_t hits_out) const { return hits_in + 1 + hits_out <= max_bounces; }
};

// Says where the columns of the paths and their hits are written (Paths).
struct PathRows {
  Hit* hits;
  int64_t first_hit;  // index of `hits` in the record
  int64_t* offsets;
  uint8_t* num_bounces;
  uint64_t* diffuse;
  std::complex<float>* weight;
  uint16_t* stratum;
  uint8_t* batch;
  uint32_t* flags;

  void skip_rows(size_t count);
  void skip_hits(size_t count);
};

// Enumerates the pairs of legs of a fan. Paths share hits as far as they can: one that leaves directly uses the first hits
// of one that leaves over a mirror, and one that comes directly uses the last hits of one that comes over a mirror.
class FanPairs {
 public:
  // `legs` [num_in + num_out] has those in and then those out; their first_hit counts from `hits`.
  FanPairs(const PathFan& fan, const FanLeg* legs, const Hit* hits);
  void count(size_t& num_paths, size_t& num_hits) const;
  // Writes the paths by way in and then by way out, and moves `rows` behind them. `places` is scratch memory.
  void write(PathRows& rows, std::vector<int64_t>& places) const;

 private:
  struct Pair {
    uint32_t in, out;
    bool operator==(const Pair&) const = default;
  };
  uint32_t length(Pair pair) const { return in_[pair.in].num_hits + 1 + out_[pair.out].num_hits; }
  bool fits(Pair pair) const { return fan_.fits(in_[pair.in].num_hits, out_[pair.out].num_hits); }
  Pair host(Pair pair) const;  // over whose hits the path of this pair runs
  template <class Visit>
  void for_each(const Visit& visit) const;
  void write_hits(Pair pair, Hit* to) const;
  void write_row(Pair pair, int64_t offset, PathRows& rows) const;

  const PathFan& fan_;
  const FanLeg *in_, *out_;
  const Hit* hits_;
  uint32_t bent_in_, bent_out_;  // the shortest legs over a mirror; num_in, num_out: none
};

}  // namespace echopath
