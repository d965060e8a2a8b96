// Intersections as CGAL 5 (boost::variant) and CGAL 6 (std::variant) give them.
#pragma once

#include <boost/variant/get.hpp>
#include <variant>

namespace carom::geometry {

/// The alternative of that type, null if it is another one.
template <class T, class Variant>
const T* one_of(const Variant& variant) {
  if constexpr (requires { std::get_if<T>(&variant); })
    return std::get_if<T>(&variant);
  else
    return boost::get<T>(&variant);
}

}  // namespace carom::geometry
