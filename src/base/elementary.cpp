#include "carom/base/elementary.hpp"

#include <limits>

#include "carom/base/fused_product.hpp"
#include "elementary_exact.hpp"
#include "elementary_fast.hpp"

namespace carom::elementary {

namespace {

namespace fast = base::fast;
namespace exact = base::exact;
using fast::Fusing;
using fast::Result;
using fast::Splitting;

struct Sine {
  template <class Products>
  CAROM_INLINE static Result<double> of(double x) {
    return fast::sine<Products>(fast::reduced<Products>(table(), x));
  }
  CAROM_INLINE static const fast::SineTable& table() {
    static const fast::SineTable& made = fast::sine_table();
    return made;
  }
};
struct Cosine {
  template <class Products>
  CAROM_INLINE static Result<double> of(double x) {
    return fast::cosine<Products>(fast::reduced<Products>(Sine::table(), x));
  }
};
struct Both {
  struct Results {
    Result<double> sin, cos;
  };
  template <class Products>
  CAROM_INLINE static Results of(double x) {
    const fast::Angle angle = fast::reduced<Products>(Sine::table(), x);
    return {fast::sine<Products>(angle), fast::cosine<Products>(angle)};
  }
};
struct Exponential {
  template <class Products>
  CAROM_INLINE static Result<double> of(double x) {
    return fast::exp<Products, double>(table(), x);
  }
  CAROM_INLINE static const fast::ExpTable& table() {
    static const fast::ExpTable& made = fast::exp_table();
    return made;
  }
};
struct SmallExponential {
  template <class Products>
  CAROM_INLINE static Result<double> of(double x) {
    return fast::small_exp<Products>(Exponential::table(), x);
  }
};
struct Logarithm {
  template <class Products>
  CAROM_INLINE static Result<double> of(double x) {
    static const fast::LogTable& table = fast::log_table();
    return fast::log<Products>(table, x);
  }
};
struct AngleOf {
  template <class Products>
  CAROM_INLINE static Result<double> of(double y, double x) {
    static const fast::AngleTable& table = fast::angle_table();
    return fast::atan2<Products, double>(table, y, x);
  }
};

#if defined(__x86_64__) && !defined(__FMA__)
template <class Function, class... Numbers>
[[gnu::target("fma")]] auto by_instruction(Numbers... x) {
  return Function::template of<Fusing>(x...);
}
/// One text for processors that fuse products and for those that do not.
template <class Function, class... Numbers>
auto quick(Numbers... x) {
  if (detail::fuses) [[likely]]
    return by_instruction<Function>(x...);
  return Function::template of<Splitting>(x...);
}
#else
template <class Function, class... Numbers>
auto quick(Numbers... x) {
  return Function::template of<Fusing>(x...);
}
#endif

template <class Function>
double of_angle(double x, double (*exactly)(double)) {
  if (std::fabs(x) < fast::largest_angle) {
    const Result<double> r = quick<Function>(x);
    if (r.spread == 0.0) [[likely]]
      return r.value;
  }
  return exactly(x);
}

}  // namespace

double sin(double x) {
  return std::fabs(x) < fast::least_angle ? x : of_angle<Sine>(x, exact::sin);
}

double cos(double x) {
  return std::fabs(x) < fast::least_angle ? 1.0 : of_angle<Cosine>(x, exact::cos);
}

SinCos sincos(double x) {
  if (std::fabs(x) < fast::least_angle) return {x, 1.0};
  if (std::fabs(x) < fast::largest_angle) {
    const Both::Results r = quick<Both>(x);
    if (r.sin.spread == 0.0 && r.cos.spread == 0.0) [[likely]]
      return {r.sin.value, r.cos.value};
  }
  return {exact::sin(x), exact::cos(x)};
}

double atan2(double y, double x) {
  const Result<double> r = quick<AngleOf>(y, x);
  return r.spread == 0.0 ? r.value : exact::atan2(y, x);
}

double exp(double x) {
  const Result<double> r = quick<Exponential>(x);
  if (r.spread == 0.0) [[likely]]
    return r.value;
  if (x < fast::least_exp) {
    const Result<double> small = quick<SmallExponential>(x);
    if (small.spread == 0.0) return small.value;
  }
  return exact::exp(x);
}

double log(double x) {
  if (x >= std::numeric_limits<double>::min() && x <= std::numeric_limits<double>::max())
      [[likely]] {
    const Result<double> r = quick<Logarithm>(x);
    if (r.spread == 0.0) [[likely]]
      return r.value;
  }
  return exact::log(x);
}

}  // namespace carom::elementary
