// Labels of the cells of a map: for echopath.labels, which checks what its callers give.
#include <pybind11/complex.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <span>
#include <vector>

#include "call/argument.h"
#include "call/leaving.h"
#include "call/run_job.h"
#include "echopath/label/cells/cell_errors.h"
#include "echopath/label/cells/cells.h"
#include "echopath/label/cells/echo_histories.h"
#include "echopath/label/cells/middle_phase.h"
#include "echopath/signal/noise.h"
#include "echopath/spectrum/range_doppler.h"
#include "radar/window_name.h"
#include "values/array.h"

namespace echopath::bindings {
namespace {

using Powers = py::array_t<double, py::array::c_style>;  // [K, V, R]
using Cells = py::array_t<int16_t, py::array::c_style>;  // [V, R]

template <class T>
std::span<const T> view(const py::array_t<T, py::array::c_style>& array) {
  return {array.data(), static_cast<size_t>(array.size())};
}

Shape shape_of(const py::array& array) { return {array.shape(), array.shape() + array.ndim()}; }

// What `work` gives, which must not touch Python objects; other Python threads run meanwhile.
template <class Work>
auto without_gil(const Work& work) {
  const WithoutGil released;
  return work();
}

// Without its first axis.
Shape cells_of(const py::array& array) { return {array.shape() + 1, array.shape() + array.ndim()}; }

Powers checked_powers(const py::object& value) { return checked_array<double>(value, "power", "[K, V, R]"); }

py::array_t<bool> as_mask(const std::vector<uint8_t>& values, const Shape& shape) {
  py::array_t<bool> mask(shape);
  std::ranges::copy(values, mask.mutable_data());
  return mask;
}

py::array mean_power_of(const RangeDoppler& map) {
  const Shape shape{std::ssize(map.velocity), std::ssize(map.range)};
  return numpy_take(run_job("power", py::none(), [&](Job& job) { return mean_power(map, &job); }), shape);
}

double noise_of_a_cell(const Radar& radar, const py::object& window) {
  const double sample_power = noise_power(radar) * (radar.waveform.real ? 2.0 : 1.0);
  return cell_noise_power(sample_power, radar.waveform, as_map_windows(window));
}

py::array shares_of(const py::object& power) {
  const Powers powers = checked_powers(power);
  return numpy_take(without_gil([&] { return power_shares(view(powers), powers.shape(0)); }), shape_of(powers));
}

py::tuple masks_of(const py::object& power, double noise_floor, double dynamic_range) {
  const Powers powers = checked_array<double>(power, "power", "[V, R]");
  const CellMask mask = without_gil([&] { return cell_mask(view(powers), noise_floor, dynamic_range); });
  return py::make_tuple(as_mask(mask.above_noise, shape_of(powers)), as_mask(mask.labelled, shape_of(powers)));
}

py::array strongest_of(const py::object& power, const py::object& mask) {
  const Powers powers = checked_powers(power);
  const auto labelled = checked_array<bool>(mask, "mask", "[V, R]");
  const auto* first = reinterpret_cast<const uint8_t*>(labelled.data());
  const std::span<const uint8_t> cells(first, static_cast<size_t>(labelled.size()));
  return numpy_take(without_gil([&] { return strongest_part(view(powers), powers.shape(0), cells); }), cells_of(powers));
}

py::object region(const LabelRegion& made) {
  if (made.num_cells == 0) return py::none();
  py::dict out;
  out["cells"] = made.num_cells;
  out["peak"] = py::make_tuple(made.peak_row, made.peak_column, made.peak_power);
  out["rows"] = py::make_tuple(made.first_row, made.last_row);
  out["columns"] = py::make_tuple(made.first_column, made.last_column);
  return out;
}

py::list regions_of(const py::object& label, const py::object& power, int64_t num_labels, bool rows_wrap) {
  const Cells labels = checked_array<int16_t>(label, "label", "[V, R]");
  const Powers powers = checked_array<double>(power, "power", "[V, R]");
  const MapShape shape{labels.shape(0), labels.shape(1), rows_wrap};
  py::list out;
  const auto regions = without_gil([&] { return label_regions(view(labels), view(powers), num_labels, shape); });
  for (const LabelRegion& made : regions) out.append(region(made));
  return out;
}

// [K, B, V, R] -> views [B, V, R] of each part.
std::vector<std::span<const double>> by_part(const Powers& values) {
  const auto count = static_cast<size_t>(values.shape(0)), size = values.size() / std::max<size_t>(count, 1);
  std::vector<std::span<const double>> parts;
  for (size_t k = 0; k < count; ++k) parts.push_back(view(values).subspan(k * size, size));
  return parts;
}

py::tuple errors_of(const py::object& cross, const py::object& coherent, const py::object& diffuse,
                    const py::object& dominant) {
  const Powers crosses = checked_array<double>(cross, "cross", "[K, B, V, R]");
  const Powers coherents = checked_array<double>(coherent, "coherent", "[K, B, V, R]");
  const Powers diffuses = checked_array<double>(diffuse, "diffuse", "[K, B, V, R]");
  const Cells labels = checked_array<int16_t>(dominant, "dominant", "[V, R]");
  const auto of_cross = by_part(crosses), of_coherent = by_part(coherents), of_diffuse = by_part(diffuses);
  std::vector<BatchPowers> parts;
  for (size_t k = 0; k < of_cross.size(); ++k) parts.push_back({of_cross[k], of_coherent.at(k), of_diffuse.at(k)});
  ShareErrors made = run_job("errors", py::none(), [&](Job& job) {
    return share_errors(parts, static_cast<int>(crosses.shape(1)), view(labels), &job);
  });
  const Shape shape{crosses.shape(0), labels.shape(0), labels.shape(1)};
  return py::make_tuple(numpy_take(std::move(made.power), shape), numpy_take(std::move(made.power_error), shape),
                        numpy_take(std::move(made.share), shape), numpy_take(std::move(made.share_error), shape),
                        as_mask(made.certain, shape_of(labels)));
}

py::tuple histories_of(const Paths& paths, Arg<"index", VectorOf<int64_t>> index, Arg<"times", VectorOf<double>> times,
                       Arg<"middle", Real> middle) {
  for (const int64_t path : *index) {
    require(path >= 0 && path < paths.num_paths(), "index", "must lie in 0 to the number of paths", path);
  }
  EchoHistories found =
      run_job("histories", py::none(), [&](Job& job) { return echo_histories(paths, *index, *times, *middle, &job); });
  const Shape shape{std::ssize(*index), std::ssize(*times)};
  return py::make_tuple(numpy_take(std::move(found.field), shape), numpy_take(std::move(found.farther), shape),
                        numpy_take(std::move(found.largest)));
}

py::array middle_phases_of(const py::array_t<double, py::array::c_style>& lengths, const ChirpSequence& waveform) {
  return numpy_take(without_gil([&] { return middle_phases(waveform, view(lengths)); }), shape_of(lengths));
}

using ComplexTable = py::array_t<std::complex<float>, py::array::c_style>;

py::array row_sums_of(const ComplexTable& table, const py::array_t<int32_t, py::array::c_style>& rows,
                      const ComplexTable& weights) {
  require(table.ndim() == 2, "table", "must be [N, T]", table.ndim());
  require(weights.ndim() == 2 && table.shape(1) == weights.shape(1), "weights", "must be [W, T] for a table [N, T]",
          weights.ndim());
  for (const int32_t row : view(rows)) require(row >= 0 && row < table.shape(0), "rows", "must be of the table", row);
  const auto num_times = static_cast<size_t>(table.shape(1));
  return numpy_take(without_gil([&] { return weighted_row_sums(view(table), view(rows), view(weights), num_times); }),
                    {weights.shape(0), rows.size()});
}

}  // namespace

void bind_cells(py::module_& m) {
  m.def("mean_power", &mean_power_of, py::arg("spectrum"), "Mean over the channels of |value|^2, [V, R] in W.");
  m.def("cell_noise_power", &noise_of_a_cell, py::arg("radar"), py::arg("window"),
        "Mean power of the receiver's noise in a cell of a range-Doppler map, W.");
  m.def("power_shares", &shares_of, py::arg("power"), "Shares of the powers [K, V, R] in their sums.");
  m.def("cell_masks", &masks_of, py::arg("power"), py::arg("noise_floor"), py::arg("dynamic_range"),
        "(above_noise, labelled), bool [V, R], of powers [V, R].");
  m.def("strongest_part", &strongest_of, py::arg("power"), py::arg("mask"),
        "Index of the largest of [K, V, R], -1 outside.");
  m.def("label_regions", &regions_of, py::arg("label"), py::arg("power"), py::arg("num_labels"), py::arg("rows_wrap"),
        "Cells, peak and box of each label: list of dict or None.");
  m.def("echo_histories", &histories_of, py::arg("paths"), py::arg("index"), py::arg("times"), py::arg("middle"),
        "(fields over the largest c64 [N, T], m farther away than at `middle` f32 [N, T], largest [N] in sqrt(W)) of the "
        "paths of an index [N] at times [T] in s, between the first antennas.");
  m.def("middle_phases", &middle_phases_of, py::arg("lengths"), py::arg("waveform"),
        "Phase factors, complex of the shape of the lengths in m, of the signals of echoes in the middle of a chirp.");
  m.def("weighted_row_sums", &row_sums_of, py::arg("table"), py::arg("rows"), py::arg("weights"),
        "Sums over rows [K] of a table c64 [N, T] with each of some weights c64 [W, T]: c64 [W, K].");
  m.def("share_errors", &errors_of, py::arg("cross"), py::arg("coherent"), py::arg("diffuse"), py::arg("dominant"),
        "(power, its error, share, its error [K, V, R], certain [V, R]) from sums of batches [K, B, V, R].");
}

}  // namespace echopath::bindings
