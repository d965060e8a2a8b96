#include "table/direction.hpp"

#include <mpfr.h>

#include "table/numbers.hpp"

namespace carom::table {
namespace {

struct Multiple {
  explicit Multiple() { mpfr_init2(value, 200); }
  Multiple(const Multiple&) = delete;
  Multiple& operator=(const Multiple&) = delete;
  ~Multiple() { mpfr_clear(value); }
  mpfr_t value;
};

}  // namespace

geometry::Vector direction(const ExactNumber& angle, int part, int whole, double length) {
  const double turns = shapes::derived(shapes::quoted(angle) + "/(2*pi)", angle).to_double();
  // (turns * whole + part) / whole turns, the numerator exact in 200 bits.
  Multiple numerator, component;
  mpfr_set_d(numerator.value, turns, MPFR_RNDN);
  mpfr_mul_si(numerator.value, numerator.value, whole, MPFR_RNDN);
  mpfr_add_si(numerator.value, numerator.value, part, MPFR_RNDN);
  const auto unsigned_whole = static_cast<unsigned long>(whole);
  mpfr_cosu(component.value, numerator.value, unsigned_whole, MPFR_RNDN);
  mpfr_mul_d(component.value, component.value, length, MPFR_RNDN);
  const double x = mpfr_get_d(component.value, MPFR_RNDN) + 0.0;  // no negative zero
  mpfr_sinu(component.value, numerator.value, unsigned_whole, MPFR_RNDN);
  mpfr_mul_d(component.value, component.value, length, MPFR_RNDN);
  return {x, mpfr_get_d(component.value, MPFR_RNDN) + 0.0};
}

}  // namespace carom::table
