#include "echopath/spectrum/angle/angle_fft.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/fft/fft.h"
#include "echopath/spectrum/array/steering.h"
#include "echopath/spectrum/array/tdm.h"

namespace echopath {
namespace {

using Complex = std::complex<double>;
constexpr int64_t kRangesPerTask = 8;  // neighbouring range bins share cache lines

// Holds one axis of the grid: its transform and the direction cosines of its bins.
struct Axis {
  Fft fft;
  int64_t num_points;
  std::vector<double> cosine;   // [bins]
  std::vector<Complex> phasor;  // [bins] takes the phase from the grid's origin to the array's centre

  Axis(int points, int zero_pad, double spacing, double offset, double wavelength)
      : fft(points > 1 ? points * zero_pad : 1, FftDirection::kBackward), num_points(points) {
    const int middle = fft.size() / 2;
    for (int i = 0; i < fft.size(); ++i) {
      cosine.push_back(points > 1 ? (i - middle) * wavelength / (spacing * fft.size()) : 0.0);
      phasor.push_back(std::polar(1.0, kTwoPi / wavelength * offset * cosine.back()));
    }
  }
  int64_t size() const { return fft.size(); }
  // Returns the bin of the transform that holds direction cosine i.
  int64_t bin(int64_t i) const { return (i + size() - size() / 2) % size(); }
};

// Transforms fields at the elements of one array to directions.
class GridTransform {
 public:
  GridTransform(const VirtualArray& array, const AngleFftOptions& options)
      : array_(array), weights_(element_weights(array, options.window)),
        columns_(axis(array.grid->num_columns, options.zero_pad, array.grid->column_spacing, array.grid->column_axis)),
        rows_(axis(array.grid->num_rows, options.zero_pad, array.grid->row_spacing, array.grid->row_axis)) {}

  const Axis& columns() const { return columns_; }
  const Axis& rows() const { return rows_; }

  // Takes element [elements] to spectrum [rows, columns]; the buffers have the sizes of the axes.
  void operator()(const Eigen::Ref<const Eigen::VectorXcd>& element, std::vector<Complex>& spectrum, FftBuffer& row,
                  FftBuffer& column) const {
    const int64_t width = columns_.size();
    spectrum.assign(rows_.size() * width, Complex());
    for (size_t e = 0; e < weights_.size(); ++e) {
      const VirtualElement& at = array_.elements[e];
      spectrum[at.row * width + at.column] = weights_[e] * element[static_cast<int64_t>(e)];
    }
    for (int64_t r = 0; r < rows_.num_points; ++r) along(columns_, spectrum.data() + r * width, 1, row);
    for (int64_t c = 0; c < width; ++c) along(rows_, spectrum.data() + c, width, column);
  }

 private:
  Axis axis(int points, int zero_pad, double spacing, const Vec3& direction) const {
    return Axis(points, zero_pad, spacing, (array_.grid->origin - array_.centre()).dot(direction), array_.wavelength);
  }

  static void along(const Axis& axis, Complex* line, int64_t stride, FftBuffer& buffer) {
    for (int64_t i = 0; i < axis.size(); ++i) buffer[i] = i < axis.num_points ? line[i * stride] : Complex();
    axis.fft.transform(buffer);
    for (int64_t i = 0; i < axis.size(); ++i) line[i * stride] = axis.phasor[i] * buffer[axis.bin(i)];
  }

  const VirtualArray& array_;
  std::vector<double> weights_;
  Axis columns_, rows_;
};

}  // namespace

std::vector<double> angles_of(const std::vector<double>& direction_cosine) {
  std::vector<double> angles;
  for (const double sine : direction_cosine) {
    angles.push_back(std::abs(sine) <= 1.0 ? std::asin(sine) : std::numeric_limits<double>::quiet_NaN());
  }
  return angles;
}

AngleSpectrum angle_fft(const RangeDoppler& map, const Radar& radar, const AngleFftOptions& options, Job* job) {
  const VirtualArray array = virtual_array(radar);
  require_map_of(map, radar);
  require(options.zero_pad >= 1 && options.zero_pad <= kMaxZeroPad, "zero_pad", "must be in [1, 64]", options.zero_pad);
  require(array.grid.has_value(), "radar", "must have a virtual array of equal steps for angle_fft (beamform takes any)",
          std::to_string(array.elements.size()) + " elements that are on no such grid");
  const ElementReader reader(map, array, radar, options.overlaps, options.compensate);
  const GridTransform transform(array, options);
  const int64_t num_ranges = reader.num_ranges(), num_cells = reader.num_velocities() * num_ranges;
  const int64_t num_directions = transform.rows().size() * transform.columns().size();
  AngleSpectrum result{transform.columns().cosine, transform.rows().cosine, map.velocity, map.range,
                       std::vector<Complex>(num_directions * num_cells)};

  const int64_t num_strips = num_chunks(num_ranges, kRangesPerTask);
  const int64_t num_tasks = reader.num_velocities() * num_strips;
  if (job) job->start(num_tasks);
  parallel_for(num_tasks, [&](int64_t task) {
    const int64_t velocity = task / num_strips, first = task % num_strips * kRangesPerTask;
    const int64_t count = std::min(kRangesPerTask, num_ranges - first);
    Eigen::MatrixXcd elements(reader.num_elements(), count);
    reader.read(velocity, first, count, elements);
    FftBuffer row(transform.columns().size()), column(transform.rows().size());
    std::vector<Complex> spectrum;
    for (int64_t r = 0; r < count; ++r) {
      transform(elements.col(r), spectrum, row, column);
      Complex* out = result.values.data() + velocity * num_ranges + first + r;
      for (int64_t d = 0; d < num_directions; ++d) out[d * num_cells] = spectrum[d];
    }
  }, job);
  return result;
}

}  // namespace echopath
