#include "certify/wall/rational_table.hpp"

#include <string>

#include "certify/wall/table_builder.hpp"
#include "table/numbers.hpp"

namespace carom::certify {

template <>
struct Source<Rational> {
  static Rational value(const ExactNumber& number) { return Rational(number); }
  static VectorOf<Rational> direction(const ExactNumber& angle, long part = 0, long whole = 1) {
    const std::string turns = table::shapes::quoted(angle) + "/(2*pi)+" + std::to_string(part) +
                              "/" + std::to_string(whole);
    const Rational quarters(ExactNumber("4*(" + turns + ")"));
    const mpq_class* const q = quarters.value();
    if (q == nullptr || q->get_den() != 1) return {Rational::unknown(), Rational::unknown()};
    const int cosines[] = {1, 0, -1, 0};
    const unsigned long k = mpz_fdiv_ui(q->get_num_mpz_t(), 4);
    return {cosines[k], cosines[(k + 3) % 4]};
  }
};

VectorOf<Rational> rational_direction(const ExactNumber& angle) {
  return Source<Rational>::direction(angle);
}

TableOf<Rational> rational_table(const TableSpec& spec) { return table_of<Rational>(spec); }

}  // namespace carom::certify
