// What results hold, described once. Beside a struct is the list of its fields: archives, JSON,
// rows in Python and the tables of the guide are made from it.
#pragma once

#include <cstdint>
#include <functional>
#include <tuple>
#include <type_traits>

namespace carom {

/// Name, unit ("1": a pure number) and meaning. The name "energy_error.end" is in archives
/// energy_error_end, in JSON the key `end` of `energy_error`.
struct Label {
  const char* name;
  const char* unit;
  const char* text;
};

/// `At` is a pointer to a member, or a function that takes the struct by `auto&` and returns a
/// reference to what lies deeper. Archives hold it as `Kept`.
template <class Kept, class At>
struct Field {
  using kept_type = Kept;
  Label label;
  At at;
  bool later = false;  ///< archives may lack it: then it keeps its default

  Kept kept(const auto& s) const { return static_cast<Kept>(std::invoke(at, s)); }
  void set(auto& s, Kept value) const {
    auto& place = std::invoke(at, s);
    place = static_cast<std::remove_reference_t<decltype(place)>>(value);
  }
};

/// The list of a struct: a specialisation has `static constexpr std::tuple list{field(…), …}`.
template <class Struct>
struct Fields;

/// Whole numbers are kept in their width; truth, names and what is shorter in 32 bits.
template <class T>
using kept_type = std::conditional_t<std::is_enum_v<T> || (std::is_integral_v<T> && sizeof(T) < 4),
                                     std::int32_t, T>;

template <class Struct, class T>
constexpr auto field(const char* name, const char* unit, const char* text, T Struct::*at) {
  return Field<kept_type<T>, T Struct::*>{{name, unit, text}, at};
}
template <class Kept, class At>
constexpr auto field_as(const char* name, const char* unit, const char* text, At at) {
  return Field<Kept, At>{{name, unit, text}, at};
}
template <class Kept, class At>
constexpr auto later(Field<Kept, At> field) {
  field.later = true;
  return field;
}

/// Calls `visit` with each field of a list, which is Fields<Struct> or a longer one.
template <class List, class Visit>
constexpr void each_field(Visit visit) {
  std::apply([&](const auto&... one) { (visit(one), ...); }, List::list);
}
/// Adds each field of other to that of sum.
template <class Struct>
void add_fields(Struct& sum, const Struct& other) {
  each_field<Fields<Struct>>(
      [&](const auto& one) { std::invoke(one.at, sum) += std::invoke(one.at, other); });
}

}  // namespace carom
