// NumPy arrays that own what C++ has computed: nothing is copied.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

namespace carom::python {

template <class Row>
pybind11::array_t<Row> array_of(std::shared_ptr<const std::vector<Row>> rows) {
  auto* const owner = new std::shared_ptr<const std::vector<Row>>(std::move(rows));
  const pybind11::capsule base(
      owner, [](void* p) { delete static_cast<std::shared_ptr<const std::vector<Row>>*>(p); });
  pybind11::array_t<Row> array({(*owner)->size()}, {sizeof(Row)}, (*owner)->data(), base);
  pybind11::detail::array_proxy(array.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
template <class Row>
pybind11::array_t<Row> array_of(std::vector<Row>&& rows) {
  return array_of(std::make_shared<const std::vector<Row>>(std::move(rows)));
}

}  // namespace carom::python
