#pragma once
// The mean received power of a set of paths and how well the rays know it.
#include "echopath/base/job.h"
#include "echopath/trace/paths.h"

namespace echopath {

// At the trace time, between two antennas, at the start frequency. The mean is over the random phases of diffuse
// hits.
struct ReceivedPower {
  double power = 0.0;           // W, coherent + diffuse
  double standard_error = 0.0;  // W, of `power`; NaN for less than two batches
  // W: |field|^2 of the coherent paths; with batches free of the bias by noise, which can take it below zero.
  double coherent = 0.0;
  double coherent_error = 0.0;  // W
  // W: sum over the diffuse hits of |field of all paths over this hit|^2. They share its random phase, so that both
  // orders of a path over a mirror, and of a chain of several diffuse hits, add as fields; different hits add as powers.
  double diffuse = 0.0;
  double diffuse_error = 0.0;   // W
  bool resolved = false;        // the power is at least twice its standard error
  int num_batches = 1;

  // Standard error in dB, 10 log10(1 + standard_error / power); infinite where it is not known or not resolved.
  double error_db() const;
};

// Indices of the antennas between which a power is received.
struct Channel {
  int tx = 0, rx = 0;
};

// The power of `paths`, the whole of a trace or any selection of it: the paths of each batch of rays, times the number
// of batches, are one independent estimate; paths without rays (image method) belong to each. From the estimates C_b of
// the field and P_b of the diffuse power of B batches:
//   coherent = (|sum C_b|^2 - sum |C_b|^2)/(B (B - 1)),  diffuse = mean P_b,
//   SE^2 = sum (2 Re[m* (C_b - mean C)] + P_b - mean P)^2/(B (B - 1)) + s^4/(B (B - 1)),  |m|^2 = max(coherent, 0),
// s^2 the variance of the C_b, m in the direction of their mean. For noise that is the same in all directions the
// coherent part is 2 |m|^2 s^2/B + s^4/(B (B - 1)), but the error of a lattice may lie along its field. Pure noise gets
// an error up to 40 % too large. One batch: |sum a|^2 and no errors. What all batches have in common, such as the
// coarseness of a mesh or what the footprint filter takes away, shows in no error. A job advances by paths. Raises
// out_of_range for antennas that the radar of the trace does not have; Cancelled.
ReceivedPower received_power(const Paths& paths, Job* job = nullptr, Channel channel = {});

}  // namespace echopath
