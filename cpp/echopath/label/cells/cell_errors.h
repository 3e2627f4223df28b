#pragma once
// Estimates from independent batches of rays how well the mean power of each part in each cell, and its share, are known.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"

namespace echopath {

// Holds sums over the channels of a map for B batches of one part, in W, as means over the channels. The field C_b
// [channels] is B times the coherent field of the paths of batch b, plus that of the paths that belong to no batch; d_b is
// the field of its diffuse paths.
struct BatchPowers {
  std::span<const double> cross;     // [B, N] Re[mean(C)* C_b]
  std::span<const double> coherent;  // [B, N] |C_b|^2
  std::span<const double> diffuse;   // [B, N] B |d_b|^2
};

struct ShareErrors {
  std::vector<double> power;        // [K, N] W, mean power over the random phases of diffuse hits, >= 0
  std::vector<double> power_error;  // [K, N] W, standard error
  std::vector<double> share;        // [K, N] of these powers; 0 where they are all 0
  std::vector<double> share_error;  // [K, N] standard error
  // [N] 1 where the `dominant` part has the largest share and leads each other one by at least two standard errors of the
  // difference
  std::vector<uint8_t> certain;
};

// Returns the power P = max(U + D, 0) of each part, its share and their errors. The coherent power U = (B^2 |mean C|^2 - sum
// |C_b|^2)/(B (B - 1)) is free of the bias by noise; the diffuse power is D = mean B |d_b|^2. The influence of each batch on
// P follows from the delta method:
//   x_b = 2 f (Re[mean(C)* C_b] - |mean C|^2) + B |d_b|^2 - D,   f^2 = max(U, 0)/|mean C|^2,
//   SE^2 = sum x_b^2/(B (B - 1)) + n,
// where n = s^4/(B (B - 1)), with s^2 the variance of the C_b, is the variance that noise alone makes (second order), as in
// power/received_power.h. Errors of shares and of their differences come from a jackknife over the shares of P - x_b/(B -
// 1), which allows for the covariance of parts by the same rays and for a share being no linear function of powers, and from
// n as above. s^4 takes the channels as copies of each other but for a phase, as the elements of one array are for one cell;
// channels that differ get too large an error.
// dominant [N] is the part that a label names, -1 for none. Raises invalid_argument without parts, for less than two batches
// or when sizes differ; raises Cancelled when the job is cancelled.
ShareErrors share_errors(const std::vector<BatchPowers>& parts, int num_batches, std::span<const int16_t> dominant,
                         Job* job = nullptr);

}  // namespace echopath
