// Formulas as they are typed: each operation is written into a list of operations on doubles.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/formula_words.hpp"
#include "carom/base/exact_number.hpp"
#include "forces/formula.hpp"

namespace carom::forces::formula {
namespace {

using base::Fault;

constexpr std::pair<const char*, double> constants[] = {{"pi", 0x1.921fb54442d18p1},
                                                        {"e", 0x1.5bf0a8b145769p1}};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

class Typed {
 public:
  using Value = Part;
  static constexpr const base::Dialect& dialect = base::formula_dialect;

  Typed(std::span<const std::string> variables, const std::map<std::string, double>& parameters)
      : variables_(variables), parameters_(parameters), builder_(variables.size()) {}

  // A name that means two things would be read as one of them in silence.
  void check_parameters(const Place& place) const {
    const auto letter = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    for (const auto& [name, value] : parameters_) {
      const bool variable =
          std::find(variables_.begin(), variables_.end(), name) != variables_.end();
      if (variable || is_constant(name) || base::formula_word(name) != nullptr) {
        throw InputError(place, "the name of parameter '" + name + "' is taken", "another name");
      }
      const bool typable = !name.empty() && letter(name.front()) &&
                           std::all_of(name.begin(), name.end(),
                                       [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
      if (!typable) {
        throw InputError(place, "a parameter cannot be called '" + name + "'",
                         "letters, digits and '_', a letter first");
      }
      if (!std::isfinite(value))
        throw InputError(place, "parameter '" + name + "' is not a finite number");
    }
  }
  Formula finish(Part result) { return builder_.finish(result); }

  std::string empty() const { return "a formula in " + joined(variables()); }
  Part operate(char what, Part a, Part b) {
    return checked([&] {
      return what == '+'   ? builder_.sum(a, b)
             : what == '-' ? builder_.difference(a, b)
             : what == '*' ? builder_.product(a, b)
                           : builder_.quotient(a, b);
    });
  }
  Part negative(Part a) {
    return checked([&] { return builder_.negative(a); });
  }
  static void check_exponent(Part b) {
    if (b.is_number && std::fabs(b.number) > most_exponent)
      throw Fault{"the exponent is too large",
                  "at most " + std::to_string(static_cast<int>(most_exponent)) + " in size"};
  }
  Part power(Part a, Part b) {
    return checked([&] { return builder_.power(a, b); });
  }
  static int arguments_of(const std::string& word) { return base::arguments_of_formula_word(word); }
  Part call(const std::string& word, const std::vector<Part>& of) {
    const Operation operation = base::formula_word(word)->operation;
    return checked([&] {
      return of.size() == 1 ? builder_.unary(operation, of[0])
                            : builder_.binary(operation, of[0], of[1]);
    });
  }
  Part named(const std::string& word, bool called) const {
    for (std::size_t v = 0; v < variables_.size(); ++v)
      if (variables_[v] == word) return builder_.variable(v);
    if (const auto p = parameters_.find(word); p != parameters_.end())
      return Builder::number(p->second);
    for (const auto& [name, value] : constants)
      if (name == word) return Builder::number(value);

    std::vector<std::string> values = variables(), all;
    for (const auto& p : parameters_) values.push_back(p.first);
    for (const auto& c : constants) values.emplace_back(c.first);
    for (const base::FormulaWord& w : base::formula_words) all.emplace_back(w.name);
    if (called)
      throw Fault{"unknown function '" + word + "'", joined(all), nearest_name(word, all)};
    if (word == "inf" || word == "nan" || word == "infinity")
      throw Fault{"'" + word + "' is not a finite number"};
    all.insert(all.begin(), values.begin(), values.end());
    throw Fault{"unknown name '" + word + "'", joined(values) + " or a function",
                nearest_name(word, all)};
  }
  static Part decimal(std::string_view written) {
    try {
      return Builder::number(ExactNumber(written, Place{}).to_double());
    } catch (const InputError& error) {
      throw Fault{"'" + std::string(written) + "' is no double: " + error.problem(),
                  error.expected()};
    }
  }

 private:
  static bool is_constant(const std::string& word) {
    return std::any_of(std::begin(constants), std::end(constants),
                       [&](const auto& c) { return c.first == word; });
  }
  std::vector<std::string> variables() const { return {variables_.begin(), variables_.end()}; }

  // A part that is a number has to be finite.
  static Part checked(auto operate) {
    std::optional<Part> part;
    try {
      part = operate();
    } catch (const TooLong&) {
      throw Fault{"the formula has too many operations", "at most " + std::to_string(most_slots)};
    }
    if (part->is_number && !std::isfinite(part->number))
      throw Fault{std::isnan(part->number) ? "this has no value" : "this is not finite"};
    return *part;
  }

  std::span<const std::string> variables_;
  const std::map<std::string, double>& parameters_;
  Builder builder_;
};

}  // namespace

Formula parse(std::string_view text, std::span<const std::string> variables,
              const std::map<std::string, double>& parameters, const Place& place) {
  if (variables.empty() || variables.size() > most_variables) {
    throw InternalError("formulas have one to three variables");
  }
  Typed meaning(variables, parameters);
  meaning.check_parameters(place);
  const Part result = base::Grammar<Typed>(text, place, meaning).parse();
  return meaning.finish(result);
}

}  // namespace carom::forces::formula
