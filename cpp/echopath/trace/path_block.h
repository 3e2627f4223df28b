#pragma once
// What one chunk of rays records, until it becomes a part of the record (record_writer.h).
#include <vector>

#include "echopath/trace/path_fan.h"

namespace echopath {

class PathBlock {
 public:
  struct Row {
    int64_t offset;  // of its first hit among `hits`
    uint64_t diffuse;
    std::complex<float> weight;
    uint32_t flags;
    uint8_t num_bounces, stratum, batch;
  };
  std::vector<Hit> hits;
  std::vector<Row> rows;  // the paths that are not of fans
  uint8_t current_batch = kNoBatch;  // of the paths added from now on
  uint32_t current_half = 0;         // likewise: 0 or kSecondHalf
  std::vector<std::array<float, 7>> curved_cell;  // of the paths so far that end behind a curved bounce, and zeros before
  std::vector<JonesMatrix> jones;  // likewise
  TraceStatistics statistics;
  std::vector<PathFan> fans;
  std::vector<FanLeg> fan_legs;  // of each fan in turn
  std::vector<Hit> fan_hits;     // of their mirrors

  // A path with hits of its own.
  void add(const Hit* first, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);
  // A path over the first `count` hits of the current ray, which all such paths share.
  void add_prefix(int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);
  // A path over `first` [count], given in the order in which it was traced, that runs the other way (kReversedPath).
  void add_reversal(const Hit* first, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);
  // Paths over `hit` and every pair of legs that `add_leg` adds next, those in and then those out, but for those of more than
  // `max_bounces` hits. `end_fan` follows.
  void begin_fan(const Hit& hit, int stratum, int max_bounces);
  void add_leg_in(std::complex<double> factor) { ++fans.back().num_in; add_leg(factor); }
  void add_leg_out(std::complex<double> factor) { ++fans.back().num_out; add_leg(factor); }
  // The next hit of the leg added last, in order of travel.
  void add_leg_hit(const Hit& hit);
  void end_fan();
  // Give the last path added its matrix (Paths::jones) and a launch cell of its own (Paths::curved_cell).
  void set_jones(const JonesMatrix& matrix);
  void set_curved_cell(const std::array<float, 7>& cell);
  // Stores the hits of the current ray as far as its paths use them.
  void end_ray(const Hit* ray_hits);
  // Of the record that this block becomes.
  size_t num_paths() const { return rows.size() + num_fan_paths_; }
  size_t num_hits() const { return hits.size() + num_fan_hits_; }
  // Writes them all in the order in which they were added. `paths`: whose optional columns are there if this block has any.
  void write(PathRows to, Paths& paths) const;
  // Forgets everything but its memory.
  void clear();

 private:
  void add_leg(std::complex<double> factor);
  void write_own(size_t begin, size_t end, int64_t first_hit, size_t row, PathRows& to, Paths& paths) const;
  void add_record(int64_t offset, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);

  size_t first_of_ray_ = 0;  // path of the current ray
  int used_depth_ = 0;       // of its hits, by paths over the first of them, whose offset is kOfRay until it ends
  size_t num_fan_paths_ = 0, num_fan_hits_ = 0;
};

}  // namespace echopath
