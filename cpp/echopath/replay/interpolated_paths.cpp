// The part of the replayer that interpolates paths by polynomials, and tells which paths and meshes need that.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/replay/echo_memory.h"
#include "echopath/replay/meshes_of_path.h"
#include "echopath/replay/replay.h"
#include "echopath/replay/time/chebyshev_tails.h"

namespace echopath {
namespace {

// The strongest path is looked for among so many, evenly spaced: a weaker one in its place leaves out fewer paths.
constexpr int64_t kStrongestAmong = 1 << 14;

constexpr int64_t kPathsOfTask = 1 << 14;  // whose meshes one task looks up

// Chebyshev coefficients fall about geometrically from these values. A tail and its order give the rate, and the rate gives
// the next order to try.
constexpr double kFirstPhase = 100.0;    // rad
constexpr double kFirstAmplitude = 1.0;  // relative to the largest

// A path whose launch cell filters its amplitude down to this share of the tolerance, of what it would be without the
// filter, needs no polynomial that follows it.
constexpr double kDarkShare = 1e-5;

// Returns the order at which a tail found at `order` would be within its tolerance.
double order_for(double tolerance, double tail, double first, int order) {
  if (tail >= first) return TimeGrids::kHighestOrder;
  return order * std::log(tolerance / first) / std::log(tail / first);
}

}  // namespace

std::vector<uint32_t> Replayer::meshes_of(std::span<const int64_t> paths) const {
  std::vector<uint8_t> is_touched(paths_.scene->meshes().size());
  const auto touch = [&](uint32_t mesh) {
    const std::atomic_ref<uint8_t> flag(is_touched[mesh]);  // is written once, so that threads go on sharing its memory
    if (!flag.load(std::memory_order_relaxed)) flag.store(1, std::memory_order_relaxed);
  };
  parallel_for_chunks(std::ssize(paths), kPathsOfTask, [&](int64_t begin, int64_t end) {
    for (const int64_t path : paths.subspan(begin, end - begin)) visit_meshes(paths_, path, touch);
  });
  std::vector<uint32_t> meshes;
  for (uint32_t mesh = 0; mesh < is_touched.size(); ++mesh) {
    if (is_touched[mesh]) meshes.push_back(mesh);
  }
  return meshes;
}

void Replayer::pose_polynomial(GridIndex polynomial, std::span<const int64_t> paths) {
  posed_.pose_polynomial(polynomial, posed_.is_whole(polynomial) ? std::vector<uint32_t>() : meshes_of(paths));
}

void Replayer::find_strongest() {
  if (strongest_ > 0.0) return;
  std::vector<int64_t> some;
  const int64_t step = std::max<int64_t>(1, paths_.num_paths() / kStrongestAmong);
  for (int64_t path = 0; path < paths_.num_paths(); path += step) some.push_back(path);
  std::vector<std::complex<double>> amplitudes(some.size());
  const Moment moment{paths_.frame.trace_time, nullptr, amplitudes.data()};
  evaluate(some, {&moment, 1});
  for (const std::complex<double>& amplitude : amplitudes) strongest_ = std::max(strongest_, std::abs(amplitude));
}

// Raises the orders that paths need whose length or amplitude in one channel the polynomial does not follow.
void Replayer::raise_orders(const FrameNodes& nodes, const Echoes& echoes, std::span<const double> unfiltered,
                            std::vector<UnfollowedPath>& needed) const {
  const ChebyshevTails tails = chebyshev_tails(nodes, echoes);
  const auto raise = [&](double tolerance, double tail, double first, double& order) {
    if (tail > tolerance) order = std::max(order, order_for(tolerance, tail, first, nodes.order));
  };
  for (size_t p = 0; p < needed.size(); ++p) {
    raise(settings_.phase_tolerance, radio_.wavenumber * kSpeedOfLight * tails.delay[p], kFirstPhase,
          needed[p].order_for_length);
    if (tails.amplitude[p] <= settings_.amplitude_tolerance()) continue;
    const double dark = settings_.amplitude_tolerance() * kDarkShare * unfiltered[p];
    if (is_dark(nodes, echoes, p, dark)) continue;
    raise(settings_.amplitude_tolerance(), tails.amplitude[p], kFirstAmplitude, needed[p].order_for_amplitude);
  }
}

// Returns the amplitude in sqrt(W) below which a path is negligible; 0 where the strongest was not looked for.
double Replayer::negligible_amplitude() const {
  const double rounding = std::numeric_limits<double>::epsilon() * strongest_;
  return rounding / static_cast<double>(std::max<int64_t>(1, paths_.num_paths()));
}

// Returns [P], 1 for paths that are negligible in all channels.
std::vector<uint8_t> Replayer::negligible_ones(const FrameNodes& nodes, std::span<const Echoes> channels) const {
  std::vector<uint8_t> is_negligible(channels.front().num_echoes, 1);
  const double limit = negligible_amplitude();
  for (const Echoes& channel : channels) {
    for (size_t p = 0; p < is_negligible.size(); ++p) {  // most are told by their amplitude at the first node
      is_negligible[p] = is_negligible[p] && std::norm(channel.amplitude[p]) < limit * limit;
    }
    for (size_t p = 0; p < is_negligible.size(); ++p) {
      if (is_negligible[p]) is_negligible[p] = is_dark(nodes, channel, p, limit);
    }
  }
  return is_negligible;
}

std::vector<Echoes> Replayer::interpolated(std::span<const int64_t> indices, GridIndex index,
                                           std::vector<UnfollowedPath>& unfollowed,
                                           const SomeTransmitters& transmitters) const {
  const PosedGrid& polynomial = posed_.polynomial(index);
  std::vector<uint8_t> dark, turned(indices.size());
  std::vector<double> unfiltered(indices.size());
  std::vector<Echoes> echoes = not_dark(indices, polynomial, transmitters, {turned.data(), unfiltered.data()}, dark);
  const auto num_left = static_cast<size_t>(echoes.front().num_echoes);
  std::vector<UnfollowedPath> needed(num_left);
  for (const Echoes& channel : echoes) raise_orders(polynomial.nodes, channel, unfiltered, needed);
  const std::vector<uint8_t> is_negligible = negligible_ones(polynomial.nodes, echoes);
  std::vector<size_t> followed;
  size_t p = 0;  // among those that are left
  for (size_t place = 0; place < indices.size(); ++place) {
    if (dark[place]) {
      unfollowed.push_back({.path = indices[place], .is_negligible = true});
      continue;
    }
    if (!is_negligible[p] && needed[p].order_for_length == 0.0 && needed[p].order_for_amplitude == 0.0) {
      followed.push_back(p++);
      continue;
    }
    needed[p].path = indices[place];
    needed[p].is_turned = turned[p] != 0;
    needed[p].is_negligible = is_negligible[p] != 0;
    unfollowed.push_back(needed[p++]);
  }
  if (followed.size() == num_left) return echoes;
  for (Echoes& channel : echoes) keep_echoes(followed, channel);
  return echoes;
}

}  // namespace echopath
