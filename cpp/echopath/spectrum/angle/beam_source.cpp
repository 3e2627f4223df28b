#include "echopath/spectrum/angle/beam_source.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "echopath/base/errors.h"
#include "echopath/spectrum/array/tdm.h"

namespace echopath {
namespace {

using Eigen::MatrixXcd;

const RangeDoppler& checked(const RangeDoppler& map, const Radar& radar) {
  radar.validate();
  require_map_of(map, radar);
  return map;
}

std::vector<int> mirrored_elements(const VirtualArray& array) {
  const Vec3 centre = array.centre();
  const double tolerance = 2.0 * kArrayTolerance * array.wavelength;
  std::vector<int> mirrored;
  for (const VirtualElement& element : array.elements) {
    const Vec3 opposite = 2.0 * centre - element.position;
    const auto found = std::ranges::find_if(
        array.elements, [&](const VirtualElement& other) { return (other.position - opposite).norm() <= tolerance; });
    require(found != array.elements.end(), "forward_backward", "needs an array that is symmetric about its centre",
            "one that is not");
    mirrored.push_back(static_cast<int>(found - array.elements.begin()));
  }
  return mirrored;
}

}  // namespace

CellBeam::CellBeam(const Eigen::VectorXd& weights, const MatrixXcd& own) : snapshots_(weights.asDiagonal() * own) {}

CellBeam::CellBeam(const MatrixXcd& covariance, const MatrixXcd& own, double loading) {
  const double mean_power = covariance.trace().real() / static_cast<double>(covariance.rows());
  if (!(mean_power > 0.0)) return;
  // The covariance is in units of the mean power, because squares of weak signals would come near the smallest numbers.
  MatrixXcd loaded = covariance / mean_power;
  loaded.diagonal().array() += loading;
  const Eigen::LLT<MatrixXcd> factor(loaded);
  snapshots_ = factor.solve(own);
  root_ = factor.matrixU().solve(MatrixXcd::Identity(covariance.rows(), covariance.rows()));
}

Eigen::VectorXd CellBeam::power(const BeamKernel& beams, Combine combine, const Job* job) const {
  if (snapshots_.size() == 0) return Eigen::VectorXd::Zero(beams.num_directions());
  const Eigen::VectorXd power = beams.power(snapshots_, combine, job);
  if (root_.size() == 0) return power;
  return power.cwiseQuotient(beams.power(root_, Combine::kSum, job).cwiseAbs2());
}

BeamSource::BeamSource(const RangeDoppler& map, const Radar& radar, const BeamformOptions& options)
    : options_(options), array_(virtual_array(radar)),
      reader_(checked(map, radar), array_, radar, options.overlaps, options.compensate) {
  options.validate();
  const std::vector<double> weights = element_weights(array_, options.window);
  weights_ = Eigen::Map<const Eigen::VectorXd>(weights.data(), std::ssize(weights));
  if (options.forward_backward) mirrored_ = mirrored_elements(array_);
}

CellBeam BeamSource::cell(int64_t velocity, int64_t range, const EchoPlace& echo) const {
  MatrixXcd own(reader_.num_elements(), 1);
  reader_.read(velocity, range, 1, own, echo);
  if (options_.method == BeamMethod::kBartlett) return {weights_, own};
  return {covariance(neighbourhood(velocity, range, echo)), own, options_.diagonal_loading};
}

CellBeam BeamSource::velocities(int64_t begin, int64_t end, int64_t range) const {
  const int64_t num_velocities = end - begin;
  const bool is_capon = options_.method == BeamMethod::kCapon;
  const int64_t reach = is_capon ? options_.range_neighbours : 0;
  const int64_t first = std::max<int64_t>(0, range - reach), last = std::min(reader_.num_ranges() - 1, range + reach);
  const int64_t count = last - first + 1;
  MatrixXcd own(reader_.num_elements(), num_velocities), all(reader_.num_elements(), num_velocities * count);
  for (int64_t v = 0; v < num_velocities; ++v) {
    reader_.read(begin + v, first, count, all.middleCols(v * count, count));
    own.col(v) = all.col(v * count + range - first);
  }
  if (!is_capon) return {weights_, own};
  return {covariance(all), own, options_.diagonal_loading};
}

MatrixXcd BeamSource::weighted(int64_t velocity, int64_t first, int64_t count) const {
  MatrixXcd snapshots(reader_.num_elements(), count);
  reader_.read(velocity, first, count, snapshots);
  return weights_.asDiagonal() * snapshots;
}

MatrixXcd BeamSource::covariance(const MatrixXcd& snapshots) const {
  const int64_t size = snapshots.rows();
  MatrixXcd half = MatrixXcd::Zero(size, size);
  half.selfadjointView<Eigen::Lower>().rankUpdate(snapshots, 1.0 / static_cast<double>(snapshots.cols()));
  const MatrixXcd mean = half.selfadjointView<Eigen::Lower>();
  if (mirrored_.empty()) return mean;
  MatrixXcd both(size, size);
  for (int64_t i = 0; i < size; ++i) {
    for (int64_t j = 0; j < size; ++j) both(i, j) = 0.5 * (mean(i, j) + std::conj(mean(mirrored_[i], mirrored_[j])));
  }
  return both;
}

MatrixXcd BeamSource::neighbourhood(int64_t velocity, int64_t range, const EchoPlace& echo) const {
  const int64_t num_velocities = reader_.num_velocities(), reach = options_.range_neighbours;
  const int64_t around = std::min<int64_t>(options_.velocity_neighbours, (num_velocities - 1) / 2);
  const int64_t first = std::max<int64_t>(0, range - reach), last = std::min(reader_.num_ranges() - 1, range + reach);
  const int64_t count = last - first + 1;
  MatrixXcd snapshots(reader_.num_elements(), (2 * around + 1) * count);
  for (int64_t step = -around; step <= around; ++step) {
    const int64_t v = velocity + step;
    const int turn = v < 0 ? -1 : (v >= num_velocities ? 1 : 0);  // beyond the axis is the next fold
    // The echo of the cell lies in its neighbours, too, with the phase between slots of its own velocity.
    const double fold = echo.fold + turn - static_cast<double>(step) / static_cast<double>(num_velocities);
    reader_.read(v - turn * num_velocities, first, count, snapshots.middleCols((step + around) * count, count),
                 {fold, echo.range});
  }
  return snapshots;
}

}  // namespace echopath
