#include "echopath/spectrum/cfar_factor/training_draws.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/random.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int kDrawsPerTask = 16;
constexpr uint64_t kSeedOfChoices = 2;

template <class One>
std::vector<TrainingDraw> draws_of(int count, Job* job, const One& one) {
  std::vector<TrainingDraw> draws(count);
  parallel_for_chunks(count, kDrawsPerTask, [&](int64_t begin, int64_t end) {
    if (job) job->throw_if_cancelled();
    for (int64_t i = begin; i < end; ++i) draws[i] = one(i);
  });
  return draws;
}

double log_mean_exp(const std::vector<double>& values) {
  const double largest = std::ranges::max(values);
  double sum = 0.0;
  for (const double value : values) sum += std::exp(value - largest);
  return largest + std::log(sum / static_cast<double>(values.size()));
}

// Returns `count` of the cells by chance (Fisher, Yates), other ones for each index.
CellGroup chosen(CellGroup cells, int64_t count, int64_t index) {
  for (int64_t i = 0; i < count; ++i) {
    const double u = uniform2(kSeedOfChoices, Stream::kTraining, static_cast<uint64_t>(index), static_cast<uint32_t>(i))[0];
    const auto rest = std::ssize(cells) - i;
    std::swap(cells[i], cells[i + std::min(static_cast<int64_t>(u * static_cast<double>(rest)), rest - 1)]);
  }
  cells.resize(count);
  return cells;
}

// Returns the log of the mean, over all choices of `order` of the values x, of e^{-tilt times their sum}: of the elementary
// symmetric polynomial over the number of its terms.
double log_mean_over_choices(std::vector<double> values, int64_t order, double tilt) {
  std::ranges::nth_element(values, values.begin() + (order - 1));
  double shift = 0.0;  // the mean of the smallest values, which make the largest term
  for (int64_t i = 0; i < order; ++i) shift += values[i] / static_cast<double>(order);
  std::vector<double> mean(order + 1, 0.0);  // of the terms over the values so far, by how many each has
  mean[0] = 1.0;
  for (size_t number = 1; number <= values.size(); ++number) {
    const double factor = std::exp(-tilt * (values[number - 1] - shift));
    for (int64_t k = std::min<int64_t>(order, static_cast<int64_t>(number)); k >= 1; --k) {
      const double share = static_cast<double>(k) / static_cast<double>(number);  // of the choices that have this value
      mean[k] = share * factor * mean[k - 1] + (1.0 - share) * mean[k];
    }
  }
  return std::log(mean[order]) - tilt * shift * static_cast<double>(order);
}

}  // namespace

// The density of the mixture over that of the noise is the mean over the groups of e^{-tilt times their sum} over its mean.
std::vector<TrainingDraw> draws_of_groups(const CfarDesign& design, const TrainingNoise& noise,
                                          const std::vector<TiltedGroup>& groups, int count, Job* job) {
  const DrawnPowers drawn(design, noise);
  std::vector<TiltedNoise> tilted;
  for (const TiltedGroup& group : groups) tilted.emplace_back(group.form, group.tilt, design.noise.num_channels);
  return draws_of(count, job, [&](int64_t index) {
    const CellPowers powers = drawn.draw(index, tilted[index % std::ssize(tilted)]);
    std::vector<double> log_ratios;
    for (size_t i = 0; i < groups.size(); ++i)
      log_ratios.push_back(-groups[i].tilt * sum_of(powers, groups[i].cells) - tilted[i].log_mean);
    return TrainingDraw{drawn.statistic(powers), -log_mean_exp(log_ratios)};
  });
}

// Think of pairs of powers and chosen cells. Draws choose all cells alike and then have the density of noise times e^{-tilt
// times the sum of those chosen} over its mean. Were cells chosen in proportion to that exponential, given the powers, the
// powers would be those of noise: the ratio is the weight.
std::vector<TrainingDraw> draws_of_chosen_cells(const CfarDesign& design, const TrainingNoise& noise, double tilt, int count,
                                                Job* job) {
  const DrawnPowers drawn(design, noise);
  const CellGroup training = training_cells(design.cells);
  return draws_of(count, job, [&](int64_t index) {
    const CellGroup cells = chosen(training, design.order(), index);
    const TiltedNoise tilted(noise.form_of_cells(cells), tilt, design.noise.num_channels);
    const CellPowers powers = drawn.draw(index, tilted);
    std::vector<double> values;
    for (const int cell : training) values.push_back(powers.data()[cell]);
    const double log_weight = tilted.log_mean - log_mean_over_choices(std::move(values), design.order(), tilt);
    return TrainingDraw{drawn.statistic(powers), log_weight};
  });
}

}  // namespace echopath
