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

struct System;

/// How the numbers of two parts of an ensemble become that of both.
enum class Join { sum, largest, least };

/// `At` is a pointer to a member, or a function that takes the struct by `auto&` and returns a
/// reference to what lies deeper. Archives hold it as `Kept`.
template <class Kept, class At>
struct Field {
  using kept_type = Kept;
  Label label;
  At at;
  bool later = false;     ///< archives may lack it: then it keeps its default
  bool archived = false;  ///< in archives alone, not in JSON
  Join join = Join::sum;
  bool (System::*there)() const = nullptr;  ///< for what systems it is reported; null: for all

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
template <class Kept, class At>
constexpr auto archived(Field<Kept, At> field) {
  field.archived = true;
  return field;
}
template <class Kept, class At>
constexpr auto joined(Join join, Field<Kept, At> field) {
  field.join = join;
  return field;
}
template <class Kept, class At>
constexpr auto reported_if(bool (System::*there)() const, Field<Kept, At> field) {
  field.there = there;
  return field;
}

/// Calls `visit` with each field of a list, which is Fields<Struct> or a longer one.
template <class List, class Visit>
constexpr void each_field(Visit visit) {
  std::apply([&](const auto&... one) { (visit(one), ...); }, List::list);
}
/// Joins each field of another part of an ensemble to that of the first.
template <class Struct>
void join_fields(Struct& all, const Struct& other) {
  each_field<Fields<Struct>>([&](const auto& one) {
    auto& value = std::invoke(one.at, all);
    const auto& more = std::invoke(one.at, other);
    if (one.join == Join::sum)
      value += more;
    else if (one.join == Join::largest ? more > value : more < value)
      value = more;
  });
}

}  // namespace carom
