#pragma once
// How well the rays know the mean power of each part in each cell, and its share: from independent batches of rays.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/base/job.h"

namespace echopath {

// Sums over the channels of a map, of B batches of one part. Field C_b [channels]: B times the coherent field of the paths
// of batch b, and that of the paths that belong to no batch; d_b: the field of its diffuse paths. W, means over the
// channels.
struct BatchPowers {
  std::span<const double> cross;     // [B, N] Re[mean(C)* C_b]
  std::span<const double> coherent;  // [B, N] |C_b|^2
  std::span<const double> diffuse;   // [B, N] B |d_b|^2
};

struct ShareErrors {
  std::vector<double> power;        // [K, N] W, mean power over the random phases of diffuse hits, >= 0
  std::vector<double> power_error;  // [K, N] W, standard error
  std::vector<double> share;        // [K, N] of these powers; 0 where there are none
  std::vector<double> share_error;  // [K, N] standard error
  // [N] 1 where `dominant` has the largest share and leads each other part by at least two standard errors of the difference
  std::vector<uint8_t> certain;
};

// Coherent power U = (B^2 |mean C|^2 - sum |C_b|^2)/(B (B - 1)), free of the bias by noise; diffuse power
// D = mean B |d_b|^2;
// the power is P = max(U + D, 0). Each batch's influence on it (delta method) is
//   x_b = 2 f (Re[mean(C)* C_b] - |mean C|^2) + B |d_b|^2 - D,   f^2 = max(U, 0)/|mean C|^2,
//   SE^2 = sum x_b^2/(B (B - 1)) + n,
// where n = s^4/(B (B - 1)), s^2 the variance of the C_b, is what noise alone has (second order), as in
// power/received_power.h. Errors of shares and of their differences: jackknife over the shares of P - x_b/(B - 1), which
// has in it the covariance of parts by the same rays and that a share is no linear function of powers; and n as above.
// s^4 takes the channels as copies of each other, which for the elements of one array seen from one cell they are, but
// for a phase;
// channels that differ get too large an error.
// dominant [N]: the part that a label names, -1: none. Raises invalid_argument without parts, for less than two batches or
// when sizes differ; Cancelled when the job is.
ShareErrors share_errors(const std::vector<BatchPowers>& parts, int num_batches, std::span<const int16_t> dominant,
                         Job* job = nullptr);

}  // namespace echopath
