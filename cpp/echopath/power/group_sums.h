#pragma once
// Sums up in one pass what groups of a record's paths send back, by batch of rays and for several widths of launch cells.
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/power/interval/power_interval.h"
#include "echopath/record/paths.h"

namespace echopath {

// Holds, beside the evidence that it gathers, what the estimates of that evidence follow from.
struct GroupSums : PowerEvidence {
  // [batches + 1] each; the last entry belongs to the paths that are in no batch.
  std::vector<std::complex<double>> field;  // sqrt(W), coherent paths as they arrive
  std::vector<double> power;                // W, of diffuse hits
  double strongest_hit = 0.0;               // W, of a diffuse hit
  double largest_field = 0.0;               // sqrt(W), sum of |a| of coherent paths that have a launch cell
  int64_t num_coherent_paths = 0, num_diffuse_hits = 0;
};

// Describes one way to sort paths into groups.
struct Sorting {
  std::span<const uint32_t> group_of_path;  // [P], below num_groups
  size_t num_groups = 0;
};

// Holds what is found of each path by itself, beside the sums.
struct PowerAndLength {
  std::vector<double> power;   // [P] W, |amplitude|^2
  std::vector<double> length;  // [P] m
};

// Returns sums [sorting, group] at the trace time, for the first antennas of `radar`. A diffuse hit counts with the field of
// all paths over it in its group, as they share its random phase. The sums of a group are those of its paths alone, to the
// last bit. `of_paths`, where given, gets the power and the length of each path between these antennas. A job advances by
// paths. Raises Cancelled.
std::vector<std::vector<GroupSums>> sum_groups(const Paths& paths, const Radar& radar, std::span<const Sorting> sortings,
                                               Job* job, PowerAndLength* of_paths);

}  // namespace echopath
