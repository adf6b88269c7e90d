// SPDX-License-Identifier: GPL-2.0-or-later
// The Python module epdem_yade: compares itself with the YADE that imports it and registers its classes.
#include "ip2.hpp"
#include "law2.hpp"

static_assert(std::is_same_v<yade::Real, double>, "epdem_yade is built for a YADE of double precision");

#define EPDEM_CLASS(Class) (Law2_ScGeom_EpPhys_##Class)
#define EPDEM_GROWTH                         \
  (EpGrowth)(Ig2_Sphere_Sphere_ScGeomGrown)( \
      Ig2_Wall_Sphere_ScGeomGrown)(Ig2_Facet_Sphere_ScGeomGrown)(Ig2_Box_Sphere_ScGeomGrown)
#define EPDEM_CLASSES \
  (EpState)(EpMat)(EpPhys)(Ip2_EpMat_EpMat_EpPhys)EPDEM_GROWTH(Law2_ScGeom_EpPhys) EPDEM_LAWS(EPDEM_CLASS)

namespace yade {
YADE_PLUGIN(EPDEM_CLASSES);
}  // namespace yade

namespace {

namespace py = boost::python;

/// Raises ImportError with one sentence.
void refuse_import(const std::string& reason) {
  PyErr_SetString(PyExc_ImportError, ("epdem_yade " + reason + "; build it for this YADE: make yade").c_str());
  py::throw_error_already_set();
}

/// Classes have another layout in a YADE of another version, precision or with other features.
void compare_with_yade() {
  const py::object config = py::import("yade.config"), builtins = py::import("builtins");
  const py::object named = config.attr("features"), once = builtins.attr("set")(named);
  const std::string version = py::extract<std::string>(config.attr("version"));
  const std::string features = py::extract<std::string>(py::str(" ").join(builtins.attr("sorted")(once)));
  const int bits = py::extract<int>(config.attr("highPrecisionBits"));
  if (version != EPDEM_YADE_VERSION) refuse_import("is built for YADE " EPDEM_YADE_VERSION ", this is YADE " + version);
  if (bits != YADE_REAL_BIT)
    refuse_import("is built for numbers of " + std::to_string(YADE_REAL_BIT) + " bits, this YADE has " +
                  std::to_string(bits));
  if (features != EPDEM_YADE_FEATURES)
    refuse_import("is built for a YADE with the features " EPDEM_YADE_FEATURES ", this YADE has " + features);
}

void register_classes() {
  compare_with_yade();
  const py::object wrapper = py::import("yade.wrapper");
#define EPDEM_NAME(r, data, Class) BOOST_PP_STRINGIZE(Class),
  for (const char* name : {BOOST_PP_SEQ_FOR_EACH(EPDEM_NAME, ~, EPDEM_CLASSES)}) {
    boost::static_pointer_cast<yade::Serializable>(yade::ClassFactory::instance().createShared(name))
        ->pyRegisterClass(wrapper);
    const py::object python = wrapper.attr(name);
    py::scope().attr(name) = python;
  }
#undef EPDEM_NAME
}

}  // namespace

// Boost's macro of a module hides the error of a registration that fails.
extern "C" BOOST_SYMBOL_EXPORT PyObject* PyInit_epdem_yade() {
  static PyModuleDef definition = {PyModuleDef_HEAD_INIT,
                                   "epdem_yade",
                                   "Elastic-plastic contact laws for YADE.",
                                   -1,
                                   nullptr,
                                   nullptr,
                                   nullptr,
                                   nullptr,
                                   nullptr};
  PyObject* const module = py::detail::init_module(definition, register_classes);
  if (!PyErr_Occurred()) return module;
  Py_XDECREF(module);
  return nullptr;
}
