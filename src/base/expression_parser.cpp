// Numbers as they are typed: each operation is folded into an exact closed form as it is read, and
// only what stays exact is allowed.
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>
#include <vector>

#include "expression.hpp"
#include "expression_grammar.hpp"

namespace carom::base::expression {
namespace {

constexpr long most_decimal_exponent = 5000;
constexpr long most_exponent = 10000;

NodePointer evaluate(auto operation) {
  try {
    return operation();
  } catch (const NoValue& reason) {
    throw Fault{reason.what()};
  }
}

struct Number {
  using Value = NodePointer;
  static constexpr Dialect dialect{.subject = "number",
                                   .operand = "a number, pi, sqrt(...) or '('",
                                   .product = "an operator (+ - * / ^)",
                                   .unclosed_before = "",
                                   .blanks = " \t",
                                   .e_is_a_name = false,
                                   .column_in_file = false};

  static std::string empty() { return "a number such as 0.5, 1/3 or sqrt(3)/2"; }
  static Value operate(char what, const Value& a, const Value& b) {
    return evaluate([&] {
      return what == '+'   ? sum(a, b)
             : what == '-' ? difference(a, b)
             : what == '*' ? product(a, b)
                           : quotient(a, b);
    });
  }
  static Value negative(const Value& a) { return operate('-', leaf({}), a); }
  static void check_exponent(const Value& b) {
    const ClosedForm& n = b->closed;
    if (b->operation != Node::Operation::leaf || !n.is_rational() || n.coefficient.get_den() != 1)
      throw Fault{"the exponent is not an integer", "an integer; sqrt(...) for a square root"};
    if (abs(n.coefficient) > most_exponent)
      throw Fault{"the exponent is too large",
                  "at most " + std::to_string(most_exponent) + " in size"};
  }
  static Value power(const Value& a, const Value& b) {
    return evaluate([&] { return expression::power(a, b->closed.coefficient.get_num().get_si()); });
  }
  static int arguments_of(const std::string& word) { return word == "sqrt" ? 1 : 0; }
  static Value call(const std::string&, const std::vector<Value>& arguments) {
    return evaluate([&] { return root(arguments.front()); });
  }
  static Value named(const std::string& word, bool) {
    if (word == "pi") return leaf({1, 1, 1});
    std::string small = word;
    for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (small == "nan" || small == "inf" || small == "infinity")
      throw Fault{"'" + word + "' is not a finite number"};
    throw Fault{"unknown word '" + word + "'", "a number, pi or sqrt(...)",
                nearest_name(word, {"pi", "sqrt"})};
  }
  static Value decimal(std::string_view written) {
    std::string text(written);
    text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
    const std::size_t e = std::min(text.find_first_of("eE"), text.size());
    std::string digits = text.substr(0, e);
    long exponent = 0;
    if (e < text.size()) {
      const char* const begin = text.data() + e + (text[e + 1] == '+' ? 2 : 1);
      const auto read = std::from_chars(begin, text.data() + text.size(), exponent);
      if (read.ec != std::errc{} || std::labs(exponent) > most_decimal_exponent)
        throw Fault{"the exponent of ten is too large",
                    "at most " + std::to_string(most_decimal_exponent) + " in size"};
    }
    if (const std::size_t point = digits.find('.'); point != std::string::npos) {
      digits.erase(point, 1);
      exponent -= static_cast<long>(digits.size() - point);
    }
    mpz_class power_of_ten;
    mpz_ui_pow_ui(power_of_ten.get_mpz_t(), 10, static_cast<unsigned long>(std::labs(exponent)));
    const mpz_class whole(digits, 10);
    mpq_class value =
        exponent < 0 ? mpq_class(whole, power_of_ten) : mpq_class(whole * power_of_ten);
    value.canonicalize();
    return evaluate([&] { return leaf({value, 1, 0}); });
  }
};

}  // namespace

NodePointer parse(std::string_view text, const Place& place) {
  Number meaning;
  return Grammar<Number>(text, place, meaning).parse();
}

}  // namespace carom::base::expression
