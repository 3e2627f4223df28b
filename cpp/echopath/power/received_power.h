#pragma once
// Estimates the mean received power of a set of paths and how well the rays know it.
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/power/group_sums.h"
#include "echopath/record/paths.h"

namespace echopath {

inline constexpr double kResolvedDb = 0.3;  // how far the interval of a resolved power may reach from it, dB

// Holds the power at the trace time, between two antennas, at the start frequency. The mean is over the random phases of
// diffuse hits. The 95 % interval, of bias and chance together, is [0, 0] where no path arrives, which tells nothing about
// what no ray has met; where faint paths were left out, it reaches up to what the lot may have taken.
struct ReceivedPower : PowerInterval {
  double power = 0.0;           // W, coherent + diffuse
  double standard_error = 0.0;  // W, of `power`, by the batches; NaN for less than two
  // This is |field|^2 of the coherent paths, W. With batches it is free of the bias by noise, which can take it below zero.
  double coherent = 0.0;
  double coherent_error = 0.0;  // W
  // This is the sum over the diffuse hits of |field of all paths over this hit|^2, W. These paths share the random phase of
  // the hit, so that both orders of a path over a mirror, and of a chain of several diffuse hits, add as fields; different
  // hits add as powers.
  double diffuse = 0.0;
  double diffuse_error = 0.0;  // W
  int num_batches = 1;

  // The estimates rest on these: the field of the coherent paths (sqrt(W), all batches), as it is and through the footprint
  // filter of cells of half the density of rays, and the sum of |a|^2 of the coherent paths without the filter, W.
  std::complex<double> field, half_density_field;
  double unfiltered = 0.0;
  double between_rays = 0.0;  // W, coherent power that launch cells may hold between rays (power_between_rays)
  int64_t num_coherent_paths = 0, num_diffuse_hits = 0;
  double strongest_share = 0.0;  // of the strongest hit in the diffuse power

  // Returns whether the interval reaches no further than `db` from the power to either side.
  bool is_within(double db) const;
  bool resolved() const { return is_within(kResolvedDb); }
  // Returns half the interval in dB, the larger one of its two sides; infinite where it reaches down to nothing.
  double interval_db() const;
  // Returns the standard error in dB, 10 log10(1 + standard_error / power); infinite where it is not known or more than half
  // the power.
  double error_db() const;
};

// Holds the indices of the antennas between which a power is received.
struct Channel {
  int tx = 0, rx = 0;
};

// Estimates the power of `paths`, the whole of a trace or any selection of it. The paths of each batch of rays, times the
// number of batches, are one independent estimate; paths without rays (image method) belong to each. From the estimates C_b
// of the field and P_b of the diffuse power of B batches follow:
//   coherent = (|sum C_b|^2 - sum |C_b|^2)/(B (B - 1)),  diffuse = mean P_b,
//   SE^2 = sum (2 Re[m* (C_b - mean C)] + P_b - mean P)^2/(B (B - 1)) + s^4/(B (B - 1)),  |m|^2 = max(coherent, 0),
// with s^2 the variance of the C_b, and m in the direction of their mean. For noise that is the same in all directions the
// coherent part is 2 |m|^2 s^2/B + s^4/(B (B - 1)), but the error of a lattice may lie along its field. Pure noise gets an
// error up to 40 % too large. One batch gives |sum a|^2 and no standard errors. What all batches have in common, such as
// what the footprint filter takes away, shows in no standard error but in the bias, and with it in the interval. That holds
// the truth for the mesh: how far facets stray from the body that somebody meant shows in none. A job advances by paths.
// Raises out_of_range for antennas that the radar of the trace does not have; raises Cancelled.
ReceivedPower received_power(const Paths& paths, Job* job = nullptr, Channel channel = {});

// Returns the powers of groups of paths, [sorting, group], in one pass over the record; that of each group is, to the last
// bit, received_power of its paths alone. `of_paths`, where given, gets the power and the length of each path between these
// antennas. Raises invalid_argument for other sizes or a group that is not there; raises Cancelled.
std::vector<std::vector<ReceivedPower>> received_powers(const Paths& paths, std::span<const Sorting> sortings,
                                                        Job* job = nullptr, Channel channel = {},
                                                        PowerAndLength* of_paths = nullptr);
// Returns the powers [group] of one sorting.
std::vector<ReceivedPower> received_powers(const Paths& paths, const Sorting& sorting, Job* job = nullptr,
                                           Channel channel = {});

}  // namespace echopath
