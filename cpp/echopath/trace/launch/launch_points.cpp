#include "echopath/trace/launch/launch_points.h"

#include <cmath>
#include <numbers>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/even_steps.h"
#include "echopath/base/random.h"
#include "echopath/trace/launch/launch_lattice.h"

namespace echopath {
namespace {

double fraction(double value) { return value - std::floor(value); }

Eigen::Vector2d polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

// Maps the unit square to the unit disc with equal areas; neighbours stay neighbours (Shirley and Chiu 1997).
Eigen::Vector2d concentric(double x, double y) {
  const double a = 2.0 * x - 1.0, b = 2.0 * y - 1.0;
  if (a == 0.0 && b == 0.0) return Eigen::Vector2d::Zero();
  if (std::abs(a) > std::abs(b)) return polar(a, 0.25 * kPi * b / a);
  return polar(b, 0.5 * kPi - 0.25 * kPi * a / b);
}

// Divides points into batches of equal size, but for one point.
class EqualShares : public LaunchPoints {
 public:
  EqualShares(int64_t num_points, std::vector<Eigen::Vector2d> shifts)
      : num_points_(num_points), shifts_(std::move(shifts)) {}
  int64_t size() const override { return num_points_; }
  double cell_area() const override { return kPi / static_cast<double>(num_points_); }
  int batch_of(int64_t index) const override {
    return static_cast<int>(((index + 1) * std::ssize(shifts_) - 1) / num_points_);
  }
  Eigen::Vector2d point(int64_t index) const override {
    const int batch = batch_of(index);
    return of_batch(index - first(batch), first(batch + 1) - first(batch), shifts_[batch]);
  }

 protected:
  virtual Eigen::Vector2d of_batch(int64_t index, int64_t count, const Eigen::Vector2d& shift) const = 0;

 private:
  int64_t first(int batch) const { return num_points_ * batch / std::ssize(shifts_); }

  int64_t num_points_;
  std::vector<Eigen::Vector2d> shifts_;
};

// Follows Vogel 1979; after the equal-area projection it is the spiral on the sphere of Swinbank and Purser 2006.
class FibonacciSpiral : public EqualShares {
  using EqualShares::EqualShares;
  Eigen::Vector2d of_batch(int64_t index, int64_t count, const Eigen::Vector2d& shift) const override {
    const auto place = static_cast<double>(index);
    const double share = (place + shift[0]) / static_cast<double>(count);
    return polar(std::sqrt(share), kTwoPi * fraction(place * (std::numbers::phi - 1.0) + shift[1]));
  }
};

class R2Sequence : public EqualShares {
  using EqualShares::EqualShares;
  Eigen::Vector2d of_batch(int64_t index, int64_t, const Eigen::Vector2d& shift) const override {
    const auto place = static_cast<double>(index);
    return concentric(fraction(shift[0] + place * kEvenStep), fraction(shift[1] + place * kEvenStep * kEvenStep));
  }
};

class RandomPoints : public EqualShares {
  using EqualShares::EqualShares;
  Eigen::Vector2d of_batch(int64_t index, int64_t, const Eigen::Vector2d& shift) const override {
    const auto seed = static_cast<uint64_t>(std::ldexp(shift[0], 53));
    const auto random = uniform2(seed, Stream::kLaunchPoint, static_cast<uint64_t>(index), 0);
    return polar(std::sqrt(random[0]), kTwoPi * random[1]);
  }
};

}  // namespace

double LaunchDomain::area() const { return is_disc() ? kPi : 4.0 * half[0] * half[1]; }

std::unique_ptr<const LaunchPoints> launch_points(Sampler sampler, const LaunchDomain& domain, int64_t num_points,
                                                  const std::vector<Eigen::Vector2d>& shifts) {
  require(sampler == Sampler::kLattice || domain.is_disc(), "sampler", "must be the lattice for strips",
          static_cast<int>(sampler));
  switch (sampler) {
    case Sampler::kLattice: return std::make_unique<LaunchLattice>(domain, num_points, shifts);
    case Sampler::kFibonacci: return std::make_unique<FibonacciSpiral>(num_points, shifts);
    case Sampler::kR2: return std::make_unique<R2Sequence>(num_points, shifts);
    case Sampler::kRandom: break;
  }
  return std::make_unique<RandomPoints>(num_points, shifts);
}

}  // namespace echopath
