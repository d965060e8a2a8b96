// Owners of what GSL allocates.
#pragma once

#include <memory>

namespace carom::analyses {

template <class T, void (*release)(T*)>
struct GslRelease {
  void operator()(T* p) const { release(p); }
};
template <class T, void (*release)(T*)>
using GslPointer = std::unique_ptr<T, GslRelease<T, release>>;

}  // namespace carom::analyses
