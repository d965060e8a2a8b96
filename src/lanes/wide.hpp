// The lanes' number: one or several registers, so that an operation need not wait for the one before it. Included by
// kernel.hpp inside the namespace of its instruction set.

using Register = simd::native_simd<double>;

template <class M>
struct TwoMasks {
  M a, b;

  TwoMasks() = default;
  INLINE TwoMasks(const M& first, const M& second) : a(first), b(second) {}
  INLINE explicit TwoMasks(bool value) : a(value), b(value) {}
  INLINE friend TwoMasks operator&&(const TwoMasks& x, const TwoMasks& y) { return {x.a && y.a, x.b && y.b}; }
  INLINE friend TwoMasks operator||(const TwoMasks& x, const TwoMasks& y) { return {x.a || y.a, x.b || y.b}; }
  INLINE friend TwoMasks operator==(const TwoMasks& x, const TwoMasks& y) { return {x.a == y.a, x.b == y.b}; }
  INLINE friend TwoMasks operator!=(const TwoMasks& x, const TwoMasks& y) { return {x.a != y.a, x.b != y.b}; }
  INLINE friend TwoMasks operator!(const TwoMasks& x) { return {!x.a, !x.b}; }
  INLINE friend bool any_of(const TwoMasks& x) { return any_of(x.a || x.b); }
};

/// The lanes of one number and then those of another.
template <class T>
struct Two {
  using mask_type = TwoMasks<typename T::mask_type>;
  T a, b;

  Two() = default;
  INLINE Two(const T& first, const T& second) : a(first), b(second) {}
  INLINE Two(double value) : a(value), b(value) {}
  INLINE friend Two operator+(const Two& x, const Two& y) { return {x.a + y.a, x.b + y.b}; }
  INLINE friend Two operator-(const Two& x, const Two& y) { return {x.a - y.a, x.b - y.b}; }
  INLINE friend Two operator*(const Two& x, const Two& y) { return {x.a * y.a, x.b * y.b}; }
  INLINE friend Two operator/(const Two& x, const Two& y) { return {x.a / y.a, x.b / y.b}; }
  INLINE friend mask_type operator<(const Two& x, const Two& y) { return {x.a < y.a, x.b < y.b}; }
  INLINE friend mask_type operator>(const Two& x, const Two& y) { return {x.a > y.a, x.b > y.b}; }
  INLINE friend mask_type operator<=(const Two& x, const Two& y) { return {x.a <= y.a, x.b <= y.b}; }
  INLINE friend mask_type operator>=(const Two& x, const Two& y) { return {x.a >= y.a, x.b >= y.b}; }
  INLINE friend mask_type operator==(const Two& x, const Two& y) { return {x.a == y.a, x.b == y.b}; }
  INLINE friend mask_type operator!=(const Two& x, const Two& y) { return {x.a != y.a, x.b != y.b}; }
  INLINE friend Two operator-(const Two& x) { return {-x.a, -x.b}; }
  INLINE friend Two abs(const Two& x) { return {abs(x.a), abs(x.b)}; }
  INLINE friend Two sqrt(const Two& x) { return {sqrt(x.a), sqrt(x.b)}; }
  INLINE friend Two min(const Two& x, const Two& y) { return {min(x.a, y.a), min(x.b, y.b)}; }
  INLINE friend Two max(const Two& x, const Two& y) { return {max(x.a, y.a), max(x.b, y.b)}; }
};

#if CAROM_LANE_REGISTERS == 4
using Real = Two<Two<Register>>;
#elif CAROM_LANE_REGISTERS == 2
using Real = Two<Register>;
#else
using Real = Register;
#endif
using Mask = Real::mask_type;
constexpr int register_width = static_cast<int>(Register::size());
constexpr int width = CAROM_LANE_REGISTERS * register_width;
template <class T>
constexpr int width_of = 2 * width_of<decltype(T::a)>;
template <>
constexpr int width_of<Register> = register_width;
template <>
constexpr int width_of<Register::mask_type> = register_width;

INLINE Register choose(const Register::mask_type& condition, const Register& yes, const Register& no) {
  Register result = no;
  simd::where(condition, result) = yes;
  return result;
}
template <class T>
INLINE Two<T> choose(const typename Two<T>::mask_type& condition, const Two<T>& yes, const Two<T>& no) {
  return {choose(condition.a, yes.a, no.a), choose(condition.b, yes.b, no.b)};
}
/// where(condition, x) = value: in those lanes alone.
struct Where {
  const Mask& condition;
  Real& x;
  INLINE void operator=(const Real& value) const { x = choose(condition, value, x); }
};
INLINE Where where(const Mask& condition, Real& x) { return {condition, x}; }

/// A number or mask of one lane.
template <class T>
INLINE auto lane_of(const T& x, int lane) {
  if constexpr (width_of<T> == register_width)
    return x[static_cast<std::size_t>(lane)];
  else
    return lane < width_of<T> / 2 ? lane_of(x.a, lane) : lane_of(x.b, lane - width_of<T> / 2);
}
template <class T>
INLINE T load_as(const double* from) {
  if constexpr (width_of<T> == register_width)
    return T(from, simd::element_aligned);
  else
    return {load_as<decltype(T::a)>(from), load_as<decltype(T::b)>(from + width_of<T> / 2)};
}
INLINE Real load(const double* from) { return load_as<Real>(from); }
template <class T>
INLINE void store(const T& x, double* to) {
  if constexpr (width_of<T> == register_width) {
    x.copy_to(to, simd::element_aligned);
  } else {
    store(x.a, to);
    store(x.b, to + width_of<T> / 2);
  }
}

/// How many numbers a look-up may choose from.
enum class Reach { few, all };

/// table[index], lane by lane; index >= 0.
template <Reach reach>
INLINE Register look_up(const double* table, const Register& index) {
#if defined(__AVX512F__)
  const Register bits = index + 0x1p52;  // the lowest bits are the index
  const __m512i i = _mm512_castpd_si512(static_cast<__m512d>(bits));
  if constexpr (reach == Reach::few)
    return Register(_mm512_permutex2var_pd(_mm512_loadu_pd(table), i, _mm512_loadu_pd(table + 8)));
  else
    return Register(_mm512_i64gather_pd(_mm512_and_si512(i, _mm512_set1_epi64(0xffff)), table, 8));
#else
  return Register([&](auto i) { return table[static_cast<int>(static_cast<double>(index[i]))]; });
#endif
}
template <Reach reach, class T>
INLINE Two<T> look_up(const double* table, const Two<T>& index) {
  return {look_up<reach>(table, index.a), look_up<reach>(table, index.b)};
}
