#include "echopath/replay/evaluate_chains.h"

#include "echopath/replay/chain_tables.h"
#include "echopath/replay/diffuse_chain.h"

namespace echopath {
namespace {

struct LegValues {
  const double *length, *factor;  // [node]
};

ECHOPATH_INLINE void combine(LegValues start, LegValues end, size_t num_nodes, double* __restrict length,
                           double* __restrict amplitude) {
  for (size_t node = 0; node < num_nodes; ++node) {
    length[node] = start.length[node] + end.length[node];
    amplitude[node] = diffuse_product(start.factor[node], end.factor[node], 1.0);
  }
}

// Of one block: tables, and the paths that are made of them.
class ChainEvaluation {
 public:
  ChainEvaluation(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants, const RadioConstants& radio)
      : num_nodes_(instants.size()), num_transmitters_(instants.front().transmitters.size()),
        num_receivers_(instants.front().receivers.size()), plan_(plan), scale_(diffuse_scale(radio)) {
    const PosedPoints points = pose_points(plan, localise, instants);
    inner_ = measure_inner(plan, points);
    legs_ = measure_legs(plan, points, pose_images(plan, localise, instants, false), pose_images(plan, localise, instants, true));
  }

  void write(size_t num_paths, std::span<const ChannelNodes> channels) const {
    std::vector<double> length(num_nodes_), amplitude(num_nodes_);
    for (const ChainPlan::Chain& chain : plan_.chains) {
      const std::complex<double> weight = scale_ * chain.weight;
      for (size_t channel = 0; channel < channels.size(); ++channel) {
        const size_t transmitter = channel / num_receivers_, receiver = channel % num_receivers_;
        const LegValues start = leg(chain.start, chain.is_reversed ? receiver : transmitter);
        const LegValues end = leg(chain.end, chain.is_reversed ? transmitter : receiver);
        if (chain.inner == ChainPlan::kNone) run_simd<combine>(start, end, num_nodes_, length.data(), amplitude.data());
        else combine_over(chain.inner, start, end, length.data(), amplitude.data());
        for (size_t node = 0; node < num_nodes_; ++node) {
          channels[channel].length[node * num_paths + chain.place] = length[node];
          channels[channel].amplitude[node * num_paths + chain.place] = weight * amplitude[node];
        }
      }
    }
  }

 private:
  LegValues leg(uint32_t id, size_t antenna) const {
    const size_t entry = id * legs_.stride + antenna;
    return {legs_.rows.row(entry, ChainLegs::kLength), legs_.rows.row(entry, ChainLegs::kFactor)};
  }

  void combine_over(uint32_t inner, const LegValues& start, const LegValues& end, double* length, double* amplitude) const {
    const auto row = [&](ChainInner::Row r) { return inner_.rows.row(inner, r); };
    const double *between = row(ChainInner::kLength), *to_first = row(ChainInner::kToFirst);
    const double *root_cos_first = row(ChainInner::kRootCosFirst), *factor = row(ChainInner::kFactor);
    const double *first_sign = row(ChainInner::kFirstSign), *last_sign = row(ChainInner::kLastSign);
    for (size_t node = 0; node < num_nodes_; ++node) {
      length[node] = start.length[node] + between[node] + end.length[node];
      const double first = inner_.begins_specular[inner]
                               ? specular_leg(start.factor[node], start.length[node], to_first[node], root_cos_first[node])
                               : start.factor[node];
      amplitude[node] = inner_.is_single[inner]
                            ? diffuse_product(first, end.factor[node], factor[node])
                            : diffuse_product(first, end.factor[node], factor[node], first_sign[node], last_sign[node]);
    }
  }

  size_t num_nodes_, num_transmitters_, num_receivers_;
  const ChainPlan& plan_;
  double scale_;
  ChainInner inner_;
  ChainLegs legs_;
};

bool has_phase(const Antenna& antenna) { return antenna.pattern.table && !antenna.pattern.table->phase().empty(); }

}  // namespace

void evaluate_chains(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants,
                     const RadioConstants& radio, size_t num_paths, std::span<const ChannelNodes> channels) {
  if (plan.chains.empty()) return;
  ChainEvaluation(plan, localise, instants, radio).write(num_paths, channels);
}

bool has_phase(const Radar& radar) {
  const auto of_one = [](const Antenna& antenna) { return has_phase(antenna); };
  return std::any_of(radar.transmitters.begin(), radar.transmitters.end(), of_one) ||
         std::any_of(radar.receivers.begin(), radar.receivers.end(), of_one);
}

}  // namespace echopath
