#include "echopath/replay/time/frame_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"

namespace echopath {
namespace {

// Returns the Chebyshev-Lobatto point x_k = cos(pi k / (K-1)), k = 0 .. K-1.
double lobatto(int k, int order) { return std::cos(kPi * k / (order - 1)); }

// Returns the row [order] that gives coefficient n of the interpolant in T_n from the values at the Lobatto points.
std::vector<double> coefficient_row(int n, int order) {
  std::vector<double> row(order);
  const bool end_row = n == 0 || n == order - 1;
  for (int k = 0; k < order; ++k) {
    const bool end_point = k == 0 || k == order - 1;
    row[k] = std::cos(kPi * n * k / (order - 1)) * 2.0 / (order - 1) * (end_point ? 0.5 : 1.0) * (end_row ? 0.5 : 1.0);
  }
  return row;
}

// Returns T_n(x) and its first three derivatives, n = 0 .. order-1.
std::vector<std::array<double, 4>> chebyshev(int order, double x) {
  std::vector<std::array<double, 4>> values = {{1.0, 0.0, 0.0, 0.0}, {x, 1.0, 0.0, 0.0}};
  for (int n = 2; n < order; ++n) {
    const std::array<double, 4>&before = values[static_cast<size_t>(n) - 2], &here = values[static_cast<size_t>(n) - 1];
    std::array<double, 4> next;
    for (size_t d = 0; d < 4; ++d)
      next[d] = 2.0 * (x * here[d] + (d > 0 ? static_cast<double>(d) * here[d - 1] : 0.0)) - before[d];
    values.push_back(next);
  }
  return values;
}

struct Piece {
  double begin, end;  // s
  double middle() const { return 0.5 * (begin + end); }
  double half() const { return 0.5 * (end - begin); }
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

// A motion that jumps where the piece ends is beyond the jump there, so the last node lies just before.
void append_times(const Piece& piece, int order, std::vector<double>& times) {
  const double last = std::max(piece.begin, std::nextafter(piece.end, piece.begin));
  for (int k = 0; k < order; ++k) {
    times.push_back(std::clamp(piece.middle() + piece.half() * lobatto(k, order), piece.begin, last));
  }
}

// Computes the weights that give values and derivatives inside one piece.
class NodeSet {
 public:
  NodeSet(int order, ChirpDerivatives derivatives)
      : order_(order), num_derivatives_(derivatives == ChirpDerivatives::kThird ? 3 : 1) {
    require(order >= 2, "order", "must be >= 2", order);
    for (int n = 0; n < order; ++n) rows_.push_back(coefficient_row(n, order));
  }

  // Appends one more chirp, at `time` in `piece`, whose nodes begin at `first_row`.
  void append_chirp(const Piece& piece, double time, int first_row, TimeSampling& sampling) const {
    // A frame of one sample has no duration and no derivatives.
    const double scale = piece.half() > 0 ? 1.0 / piece.half() : 0.0;
    const double x = std::clamp((time - piece.middle()) * scale, -1.0, 1.0);
    sampling.order = order_;
    sampling.first_row.push_back(first_row);
    const std::vector<std::array<double, 4>> basis = chebyshev(order_, x);
    std::vector<double>* const out[4] = {&sampling.value, &sampling.slope, &sampling.second_derivative,
                                         &sampling.third_derivative};
    double unit = 1.0;  // of the derivative, s^-d
    for (size_t d = 0; d <= num_derivatives_; ++d, unit *= scale) {
      out[d]->resize(out[d]->size() + static_cast<size_t>(order_), 0.0);
      double* weights = out[d]->data() + out[d]->size() - static_cast<size_t>(order_);
      for (int n = 0; n < order_; ++n) {
        const double factor = unit * basis[n][d];
        for (int k = 0; k < order_; ++k) weights[k] += factor * rows_[n][k];
      }
    }
  }

 private:
  int order_;
  size_t num_derivatives_;
  std::vector<std::vector<double>> rows_;  // [n, k]: Chebyshev coefficient n from the values at the nodes
};

// Returns the nodes of all pieces, without the weights of the chirps.
FrameNodes lobatto_nodes(const std::vector<Piece>& pieces, int order) {
  require(order >= 2, "order", "must be >= 2", order);
  FrameNodes nodes;
  nodes.order = order;
  for (const Piece& piece : pieces) append_times(piece, order, nodes.times);
  for (const int n : {order - 2, order - 1}) {
    const std::vector<double> row = coefficient_row(n, order);
    nodes.tail.insert(nodes.tail.end(), row.begin(), row.end());
  }
  return nodes;
}

}  // namespace

FrameNodes static_nodes(const Radar& radar, double time) {
  FrameNodes nodes;
  nodes.times = {time};
  nodes.sampling.assign(radar.transmitters.size(), static_sampling(radar.waveform.num_chirps));
  return nodes;
}

FrameNodes unsampled_chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints,
                                     int order) {
  const std::vector<Piece> pieces = pieces_of(start_time, start_time + radar.frame_duration(), breakpoints);
  return lobatto_nodes(pieces, order);
}

FrameNodes chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints, int order,
                           ChirpDerivatives derivatives) {
  const std::vector<Piece> pieces = pieces_of(start_time, start_time + radar.frame_duration(), breakpoints);
  const NodeSet set(order, derivatives);
  FrameNodes nodes = lobatto_nodes(pieces, order);
  for (int tx = 0; tx < static_cast<int>(radar.transmitters.size()); ++tx) {
    TimeSampling& sampling = nodes.sampling.emplace_back();
    sampling.num_rows = static_cast<int>(nodes.times.size());
    for (int chirp = 0; chirp < radar.waveform.num_chirps; ++chirp) {
      const double time = start_time + radar.chirp_time(tx, chirp);
      const auto piece = std::find_if(pieces.begin(), pieces.end() - 1, [&](const Piece& p) { return time < p.end; });
      set.append_chirp(*piece, time, static_cast<int>(piece - pieces.begin()) * order, sampling);
    }
  }
  return nodes;
}

FrameNodes exact_nodes(const Radar& radar, double start_time, int order, int transmitter, ChirpDerivatives derivatives) {
  require(order >= 3 && order % 2 == 1, "order", "must be odd and >= 3", order);
  require(transmitter >= 0 && transmitter < static_cast<int>(radar.transmitters.size()), "transmitter",
          "must be one of the radar's", transmitter);
  const double half = radar.waveform.window_centre();
  const NodeSet set(order, derivatives);
  FrameNodes nodes;
  nodes.is_exact = true;
  nodes.order = order;
  TimeSampling& sampling = nodes.sampling.emplace_back();
  for (int chirp = 0; chirp < radar.waveform.num_chirps; ++chirp) {
    const double time = start_time + radar.chirp_time(transmitter, chirp);
    const Piece piece{time - half, time + half};
    set.append_chirp(piece, time, static_cast<int>(nodes.times.size()), sampling);
    append_times(piece, order, nodes.times);
  }
  sampling.num_rows = static_cast<int>(nodes.times.size());
  return nodes;
}

FrameNodes centre_nodes(const Radar& radar, double start_time, int transmitter) {
  FrameNodes nodes;
  nodes.is_exact = true;
  for (int chirp = 0; chirp < radar.waveform.num_chirps; ++chirp)
    nodes.times.push_back(start_time + radar.chirp_time(transmitter, chirp));
  return nodes;
}

TimeSampling derivative_sampling(int num_chirps, ChirpDerivatives derivatives) {
  TimeSampling sampling;
  sampling.order = rows_of_chirp(derivatives);
  sampling.num_rows = num_chirps * sampling.order;
  sampling.rows = TimeSampling::Rows::kDerivatives;
  std::vector<double>* const weights[] = {&sampling.value, &sampling.slope, &sampling.second_derivative,
                                          &sampling.third_derivative};
  for (int d = 0; d < sampling.order; ++d) weights[d]->assign(sampling.num_rows, 0.0);
  for (int chirp = 0; chirp < num_chirps; ++chirp) {
    sampling.first_row.push_back(chirp * sampling.order);
    for (int d = 0; d < sampling.order; ++d) (*weights[d])[chirp * sampling.order + d] = 1.0;
  }
  return sampling;
}

}  // namespace echopath
