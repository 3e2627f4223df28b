#include "echopath/replay/frame_nodes.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"

namespace echopath {
namespace {

// Chebyshev-Lobatto points x_k = cos(pi k / (K-1)), k = 0 .. K-1.
double lobatto(int k, int order) { return std::cos(kPi * k / (order - 1)); }

// Coefficient n of the interpolant in T_n from the values at the Lobatto points: row [order].
std::vector<double> coefficient_row(int n, int order) {
  std::vector<double> row(static_cast<size_t>(order));
  const bool end_row = n == 0 || n == order - 1;
  for (int k = 0; k < order; ++k) {
    const bool end_point = k == 0 || k == order - 1;
    row[static_cast<size_t>(k)] = std::cos(kPi * n * k / (order - 1)) * 2.0 / (order - 1) * (end_point ? 0.5 : 1.0) *
                                  (end_row ? 0.5 : 1.0);
  }
  return row;
}

// T_n(x) and its derivative n U_{n-1}(x), both stable on [-1, 1].
std::pair<double, double> chebyshev(int n, double x) {
  double t0 = 1.0, t1 = x, u0 = 0.0, u1 = 1.0;  // T_0, T_1 and U_{-1}, U_0
  if (n == 0) return {1.0, 0.0};
  for (int i = 1; i < n; ++i) {
    std::tie(t0, t1) = std::pair(t1, 2.0 * x * t1 - t0);
    std::tie(u0, u1) = std::pair(u1, 2.0 * x * u1 - u0);
  }
  return {t1, n * u1};
}

struct Piece {
  double begin, end;  // s
};

std::vector<Piece> pieces_of(double begin, double end, const std::vector<double>& breakpoints) {
  std::vector<Piece> pieces;
  double from = begin;
  for (const double cut : breakpoints) {
    if (cut <= from || cut >= end) continue;
    pieces.push_back({from, cut});
    from = cut;
  }
  pieces.push_back({from, end});
  return pieces;
}

void fill_row(TimeSampling& sampling, int chirp, double x, double scale, const std::vector<std::vector<double>>& rows) {
  const int order = sampling.order;
  double* value = sampling.value.data() + static_cast<ptrdiff_t>(chirp) * order;
  double* slope = sampling.slope.data() + static_cast<ptrdiff_t>(chirp) * order;
  for (int n = 0; n < order; ++n) {
    const auto [t, derivative] = chebyshev(n, x);
    for (int k = 0; k < order; ++k) {
      value[k] += t * rows[static_cast<size_t>(n)][static_cast<size_t>(k)];
      slope[k] += scale * derivative * rows[static_cast<size_t>(n)][static_cast<size_t>(k)];
    }
  }
}

}  // namespace

FrameNodes static_nodes(const Radar& radar, double time) {
  FrameNodes nodes;
  nodes.times = {time};
  nodes.sampling.assign(radar.transmitters.size(), static_sampling(radar.waveform.num_chirps));
  return nodes;
}

FrameNodes chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints, int order) {
  require(order >= 2, "order", "must be >= 2", order);
  const std::vector<Piece> pieces = pieces_of(start_time, start_time + radar.frame_duration(), breakpoints);
  FrameNodes nodes;
  nodes.order = order;
  for (const Piece& piece : pieces) {
    for (int k = 0; k < order; ++k) {
      nodes.times.push_back(0.5 * (piece.begin + piece.end) + 0.5 * (piece.end - piece.begin) * lobatto(k, order));
    }
  }
  std::vector<std::vector<double>> rows;
  for (int n = 0; n < order; ++n) rows.push_back(coefficient_row(n, order));
  for (int n : {order - 2, order - 1}) nodes.tail.insert(nodes.tail.end(), rows[static_cast<size_t>(n)].begin(), rows[static_cast<size_t>(n)].end());

  const int num_chirps = radar.waveform.num_chirps;
  for (int tx = 0; tx < static_cast<int>(radar.transmitters.size()); ++tx) {
    TimeSampling sampling;
    sampling.num_nodes = static_cast<int>(nodes.times.size());
    sampling.order = order;
    sampling.value.assign(static_cast<size_t>(num_chirps) * order, 0.0);
    sampling.slope = sampling.value;
    for (int chirp = 0; chirp < num_chirps; ++chirp) {
      const double time = start_time + radar.chirp_time(tx, chirp);
      const auto behind = std::find_if(pieces.begin(), pieces.end() - 1, [&](const Piece& p) { return time < p.end; });
      const double half = 0.5 * (behind->end - behind->begin);
      sampling.first_node.push_back(static_cast<int>(behind - pieces.begin()) * order);
      fill_row(sampling, chirp, std::clamp((time - behind->begin) / half - 1.0, -1.0, 1.0), 1.0 / half, rows);
    }
    nodes.sampling.push_back(std::move(sampling));
  }
  return nodes;
}

FrameNodes exact_nodes(const Radar& radar, double start_time) {
  const int num_slots = radar.num_slots(), num_chirps = radar.waveform.num_chirps;
  FrameNodes nodes;
  nodes.is_exact = true;
  for (int chirp = 0; chirp < num_chirps; ++chirp) {
    for (int tx = 0; tx < num_slots; ++tx) nodes.times.push_back(start_time + radar.chirp_time(tx, chirp));
  }
  // Slots alternate in time, so the differences are those of neighbouring slots.
  const TimeSampling all = exact_sampling(nodes.times);
  nodes.order = all.order;
  const auto order = static_cast<size_t>(all.order);
  for (int tx = 0; tx < num_slots; ++tx) {
    TimeSampling sampling;
    sampling.num_nodes = all.num_nodes;
    sampling.order = all.order;
    for (int chirp = 0; chirp < num_chirps; ++chirp) {
      const auto slot = static_cast<size_t>(chirp) * num_slots + tx;
      sampling.first_node.push_back(all.first_node[slot]);
      const auto row = static_cast<ptrdiff_t>(slot * order);
      sampling.value.insert(sampling.value.end(), all.value.begin() + row, all.value.begin() + row + all.order);
      sampling.slope.insert(sampling.slope.end(), all.slope.begin() + row, all.slope.begin() + row + all.order);
    }
    nodes.sampling.push_back(std::move(sampling));
  }
  return nodes;
}

}  // namespace echopath
