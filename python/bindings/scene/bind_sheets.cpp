#include <pybind11/complex.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/base/errors.h"
#include "echopath/em/layers/sheet_model.h"
#include "values/array.h"

namespace echopath::bindings {
namespace {

// [5, N]: reflection TE and TM, transmission TE and TM, and the delays of both as one complex number.
py::array_t<std::complex<double>> coefficients(Arg<"material", Instance<Material>> material,
                                               Arg<"frequency", Real> frequency,
                                               Arg<"incidence", VectorOf<double>> incidence, Arg<"from_behind", Flag> behind,
                                               Arg<"bandwidth", Real> bandwidth) {
  require(material->is_sheet(), "material", "must have layers", 0);
  require(*frequency > 0, "frequency", "must be > 0 Hz", *frequency);
  require(*bandwidth >= 0, "bandwidth", "must be >= 0 Hz", *bandwidth);
  std::vector<Layer> layers = material->layers;
  if (*behind) std::ranges::reverse(layers);
  const LayerStack stack(layers, *frequency);
  const SheetModel sheet(*material, *frequency, {*frequency, *frequency + *bandwidth});
  const auto count = std::ssize(*incidence);
  py::array_t<std::complex<double>> out({py::ssize_t{5}, count});
  auto rows = out.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < count; ++i) {
    const double angle = (*incidence)[i];
    require(angle >= 0 && angle <= 1.5707963267948968, "incidence", "must lie in [0, pi/2] rad", angle);
    const double cosine = std::max(0.0, std::cos(angle));
    const FresnelModes reflected = stack.reflection(cosine);
    const LayerTransmission passed = stack.transmission(cosine);
    const SheetPassage passage = sheet.passage(cosine);
    rows(0, i) = reflected.te;
    rows(1, i) = reflected.tm;
    rows(2, i) = passed.te;
    rows(3, i) = passed.tm;
    rows(4, i) = {passage.te_delay, passage.tm_delay};
  }
  return out;
}

}  // namespace

void bind_sheets(py::module_& m) {
  define(m, "_sheet_coefficients", &coefficients, py::arg("material"), py::arg("frequency"), py::arg("incidence"),
         py::arg("from_behind") = false, py::arg("bandwidth") = 0.0);
}

}  // namespace echopath::bindings
