#include <algorithm>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/motion/deformation.h"
#include "echopath/motion/spline.h"

namespace echopath {
namespace {

using Frames = std::vector<std::vector<Vec3>>;  // [T][V]

void check_frames(const Frames& frames, size_t num_times) {
  require(frames.size() == num_times, "vertices", "must hold as many frames as times", frames.size());
  require(!frames.front().empty(), "vertices", "must hold at least one vertex", 0);
  for (const std::vector<Vec3>& frame : frames) {
    require(frame.size() == frames.front().size(), "vertices", "must have the same number in each frame", frame.size());
    for (const Vec3& vertex : frame) require(vertex.allFinite(), "vertices", "must be finite", vertex.transpose());
  }
}

Frames frame_derivatives(const SplineKnots& knots, const Frames& frames) {
  if (!knots.has_derivatives()) return {};
  Frames result(frames.size());
  std::vector<const double*> rows;
  std::vector<double*> out;
  for (size_t i = 0; i < frames.size(); ++i) {
    result[i].resize(frames[i].size());
    rows.push_back(frames[i].data()->data());
    out.push_back(result[i].data()->data());
  }
  knots.derivatives(rows, std::ssize(frames.front()), 3, out);
  return result;
}

}  // namespace

struct VertexSequence::Data {
  SplineKnots knots;
  Frames frames, derivatives;  // derivatives: [T][V] in m/s^2 of kCubic or m/s of kMonotone, empty where linear
  bool rests;

  Vec3 vertex(const SplineKnots::Weights& w, size_t i) const {
    Vec3 value = w.value[0] * frames[w.k][i] + w.value[1] * frames[w.k + 1][i];
    if (!derivatives.empty()) value += w.derivative[0] * derivatives[w.k][i] + w.derivative[1] * derivatives[w.k + 1][i];
    return value;
  }
};

VertexSequence::VertexSequence(std::vector<double> times, Frames vertices, Interpolation interpolation) {
  SplineKnots knots(std::move(times), interpolation);
  check_frames(vertices, knots.times().size());
  Frames derivatives = frame_derivatives(knots, vertices);
  const bool rests = all_equal(vertices);
  data_ = std::make_shared<const Data>(Data{std::move(knots), std::move(vertices), std::move(derivatives), rests});
}

int64_t VertexSequence::num_vertices() const { return std::ssize(data_->frames.front()); }

std::vector<Vec3> VertexSequence::at(double time) const {
  const SplineKnots::Weights weights = data_->knots.weights(time, data_->rests);
  std::vector<Vec3> out(data_->frames.front().size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = data_->vertex(weights, i);
  return out;
}

void VertexSequence::at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const {
  const SplineKnots::Weights weights = data_->knots.weights(time, data_->rests);
  const size_t num_vertices = data_->frames.front().size();
  out.resize(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    require(indices[i] < num_vertices, "indices", "must be below the number of vertices", indices[i]);
    out[i] = data_->vertex(weights, indices[i]);
  }
}

std::vector<double> VertexSequence::breakpoints(const TimeSpan&) const { return data_->knots.breakpoints(); }
TimeSpan VertexSequence::span() const { return data_->knots.span(); }
bool VertexSequence::rests() const { return data_->rests; }

double VertexSequence::turn_rate(const TimeSpan& during) const {
  const std::vector<double>& times = data_->knots.times();
  const auto [first, last] = knots_around(times, during);
  double fastest = 0.0;
  for (size_t vertex = 0; last > first + 2 && vertex < data_->frames.front().size(); ++vertex) {
    TurningPoints turns;
    for (size_t k = first; k <= last; ++k) turns.add(times[k], data_->frames[k][vertex]);
    fastest = std::max(fastest, turns.rate());
  }
  return fastest;
}

const std::vector<double>& VertexSequence::times() const { return data_->knots.times(); }
const Frames& VertexSequence::vertices() const { return data_->frames; }
Interpolation VertexSequence::interpolation() const { return data_->knots.interpolation(); }

}  // namespace echopath
