// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include "bindings.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

/// Classes of the exceptions; they live as long as the interpreter.
struct Classes {
  PyObject* error = nullptr;
  PyObject* badInput = nullptr;
  PyObject* badArgument = nullptr;
  PyObject* solverFailed = nullptr;
  PyObject* renderUnavailable = nullptr;
  PyObject* cancelled = nullptr;
};

Classes& classes() {
  static Classes all;
  return all;
}

PyObject* newClass(py::module_& m, const char* name, PyObject* base, const char* doc) {
  const std::string full = std::string("glisson.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, nullptr);
  if (made == nullptr) throw py::error_already_set();
  m.add_object(name, py::reinterpret_borrow<py::object>(made));
  return made;
}

void raise(const SolverFailed& e) {
  const py::object instance = py::reinterpret_borrow<py::object>(classes().solverFailed)(e.what());
  instance.attr("iterations") = e.iterations;
  instance.attr("residual") = e.residual;
  instance.attr("tolerance") = e.tolerance;
  PyErr_SetObject(classes().solverFailed, instance.ptr());
}

void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const BadInput& e) {
    PyErr_SetString(classes().badInput, e.what());
  } catch (const BadArgument& e) {
    PyErr_SetString(classes().badArgument, e.what());
  } catch (const SolverFailed& e) {
    raise(e);
  } catch (const RenderUnavailable& e) {
    PyErr_SetString(classes().renderUnavailable, e.what());
  } catch (const Cancelled& e) {
    PyErr_SetString(classes().cancelled, e.what());
  } catch (const Error& e) {
    PyErr_SetString(classes().error, e.what());
  }
}

}  // namespace

void bindErrors(py::module_& m) {
  Classes& c = classes();
  c.error =
      newClass(m, "Error", PyExc_Exception,
               "Root of every exception that Glisson raises on purpose. The message says what is wrong, where, the "
               "value seen and what to do; it never names a patient.");
  c.badInput = newClass(m, "BadInput", c.error, "Files, scene or region of interest cannot be used.");
  c.badArgument = newClass(m, "BadArgument", c.error, "A call broke a documented precondition.");
  c.solverFailed =
      newClass(m, "SolverFailed", c.error,
               "A solve ended without the accuracy asked for. Attributes: iterations, residual and tolerance "
               "(both relative, of |b - A x| / |b|).");
  c.renderUnavailable = newClass(m, "RenderUnavailable", c.error, "No way to draw: neither a display nor EGL.");
  c.cancelled = newClass(m, "Cancelled", c.error, "A Cancel given to the call asked to stop.");
  py::register_exception_translator(&translate);
}

}  // namespace glisson::python
