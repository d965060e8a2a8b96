#include "elementary_exact.hpp"

#include <mpfr.h>

#include <cmath>

#include "elementary_fast.hpp"

namespace carom::base {

namespace {

class Number {
 public:
  explicit Number(int digits = 53) { mpfr_init2(value_, digits); }
  explicit Number(double x) : Number() { mpfr_set_d(value_, x, MPFR_RNDN); }
  ~Number() { mpfr_clear(value_); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  operator mpfr_ptr() { return value_; }

 private:
  mpfr_t value_;
};

/// Exponents as a double has them, so that results below the normal ones are rounded once.
class ExponentsOfDoubles {
 public:
  ExponentsOfDoubles() : least_(mpfr_get_emin()), largest_(mpfr_get_emax()) {
    mpfr_set_emin(-1073);
    mpfr_set_emax(1024);
  }
  ~ExponentsOfDoubles() {
    mpfr_set_emin(least_);
    mpfr_set_emax(largest_);
  }
  ExponentsOfDoubles(const ExponentsOfDoubles&) = delete;
  ExponentsOfDoubles& operator=(const ExponentsOfDoubles&) = delete;

 private:
  mpfr_exp_t least_, largest_;
};

/// Constants and memory that MPFR keeps for a thread end with it.
struct CacheOfThread {
  ~CacheOfThread() { mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); }
  void keep() {}
};
thread_local CacheOfThread cache_of_thread;

/// function(result) fills in a result and returns on which side of the truth it is.
double rounded(auto function) {
  cache_of_thread.keep();
  Number result;
  const ExponentsOfDoubles exponents;
  const int side = function(static_cast<mpfr_ptr>(result));
  mpfr_subnormalize(result, side, MPFR_RNDN);
  return mpfr_get_d(result, MPFR_RNDN);
}

using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
double of(Unary function, double x) {
  Number argument(x);
  return rounded([&](mpfr_ptr result) { return function(result, argument, MPFR_RNDN); });
}

/// The number that `find` computes to many digits, in two doubles.
fast::Two<double> in_two(auto find) {
  Number all(160);
  find(static_cast<mpfr_ptr>(all));
  const double high = mpfr_get_d(all, MPFR_RNDN);
  mpfr_sub_d(all, all, high, MPFR_RNDN);
  return {high, mpfr_get_d(all, MPFR_RNDN)};
}
/// find(x, i) computes the entry of row i.
template <class Table, class Find>
Table filled(Find find, Table table = {}) {
  for (std::size_t i = 0; i < table.high.size(); ++i) {
    const fast::Two<double> value = in_two([&](mpfr_ptr all) { find(all, i); });
    table.high[i] = value.high;
    table.low[i] = value.low;
  }
  return table;
}

}  // namespace

namespace exact {

double sin(double x) { return of(mpfr_sin, x); }
double cos(double x) {
  // Bounds of forces ask for it again and again. What a double lacks of a quarter turn is the sine
  // of the rest.
  if (std::fabs(x) == fast::quarter_turn[0]) return fast::quarter_turn[1];
  return of(mpfr_cos, x);
}
double exp(double x) { return of(mpfr_exp, x); }
double log(double x) { return of(mpfr_log, x); }
double atan2(double y, double x) {
  // Less than y/x by a third of its cube, relatively 2^-129. No quotient of doubles is nearer than
  // 2^-107 to the middle between two doubles.
  const double quotient = y / x;
  if (x > 0.0 && std::fabs(quotient) < 0x1p-64 && std::fabs(quotient) > 0x1p-960) return quotient;
  Number opposite(y), adjacent(x);
  return rounded([&](mpfr_ptr r) { return mpfr_atan2(r, opposite, adjacent, MPFR_RNDN); });
}

}  // namespace exact

// MPFR rounds right, so that these numbers are the same everywhere, too.
namespace fast {

const ExpTable& exp_table() {
  static const auto table = filled<ExpTable>([](mpfr_ptr x, std::size_t j) {
    mpfr_set_d(x, static_cast<double>(j) / 16, MPFR_RNDN);
    mpfr_exp2(x, x, MPFR_RNDN);
  });
  return table;
}

const LogTable& log_table() {
  static const LogTable table = [] {
    LogTable t;
    for (std::size_t i = 0; i < 256; ++i) {
      const double middle = 1.0 + (static_cast<double>(i) + 0.5) / 256;
      t.c[i] = i == 0 ? 1.0 : std::floor(512 / middle + 0.5) / 512;
    }
    return filled<LogTable>(
        [&t](mpfr_ptr x, std::size_t i) {
          mpfr_set_d(x, i < halves ? t.c[i] : 2 * t.c[i], MPFR_RNDN);
          mpfr_log(x, x, MPFR_RNDN);
          mpfr_neg(x, x, MPFR_RNDN);
        },
        t);
  }();
  return table;
}

const SineTable& sine_table() {
  static const auto table = filled<SineTable>([](mpfr_ptr x, std::size_t k) {
    mpfr_const_pi(x, MPFR_RNDN);
    mpfr_mul_d(x, x, static_cast<double>(k) / 256, MPFR_RNDN);
    mpfr_sin(x, x, MPFR_RNDN);
  });
  return table;
}

const AngleTable& angle_table() {
  static const auto table = filled<AngleTable>([](mpfr_ptr x, std::size_t k) {
    mpfr_set_d(x, static_cast<double>(k) / 64, MPFR_RNDN);
    mpfr_atan(x, x, MPFR_RNDN);
  });
  return table;
}

}  // namespace fast
}  // namespace carom::base
