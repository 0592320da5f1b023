#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <unordered_set>

#include "planning/functions/standard_functions.h"

// Arithmetic and comparison. Integers have 64 bits; what does not fit becomes real.
namespace hires::planning {
namespace {

Number Whole(std::int64_t value) { return {true, value, static_cast<double>(value)}; }
Number Real(double value) { return {false, 0, value}; }

Term MakeNumber(const Call& call, const Number& number) {
  if (number.is_integer) return call.terms->Integer(number.integer);
  if (!std::isfinite(number.real)) {
    throw EvaluationError(fmt::format("'{}' gives a number beyond all measure", call.name));
  }
  return call.terms->Real(number.real + 0.0);  // never -0.0: equal numbers are equal terms
}

[[noreturn]] void RefuseZero(const Call& call) {
  throw EvaluationError(
      fmt::format("'{}' divides by 0, wanted another divisor; test it before", call.name));
}

Number Sum(const Number& a, const Number& b) {
  std::int64_t sum = 0;
  if (a.is_integer && b.is_integer && !__builtin_add_overflow(a.integer, b.integer, &sum)) {
    return Whole(sum);
  }
  return Real(a.real + b.real);
}

Number Difference(const Number& a, const Number& b) {
  std::int64_t difference = 0;
  if (a.is_integer && b.is_integer && !__builtin_sub_overflow(a.integer, b.integer, &difference)) {
    return Whole(difference);
  }
  return Real(a.real - b.real);
}

Number Product(const Number& a, const Number& b) {
  std::int64_t product = 0;
  if (a.is_integer && b.is_integer && !__builtin_mul_overflow(a.integer, b.integer, &product)) {
    return Whole(product);
  }
  return Real(a.real * b.real);
}

// The one quotient of two integers that does not fit is that of the lowest by -1.
bool QuotientFits(std::int64_t a, std::int64_t b) {
  return b != -1 || a != std::numeric_limits<std::int64_t>::min();
}

Number Quotient(const Call& call, const Number& a, const Number& b) {
  if (b.real == 0.0) RefuseZero(call);
  const bool stays_whole = a.is_integer && b.is_integer && QuotientFits(a.integer, b.integer) &&
                           a.integer % b.integer == 0;
  return stays_whole ? Whole(a.integer / b.integer) : Real(a.real / b.real);
}

template <Number (*combine)(const Number&, const Number&)>
Number Fold(const Call& call, Number start, std::size_t first) {
  for (std::size_t i = first; i < call.size(); ++i) start = combine(start, NumberAt(call, i));
  return start;
}

Term Add(const Call& call) { return MakeNumber(call, Fold<Sum>(call, Whole(0), 0)); }
Term Multiply(const Call& call) { return MakeNumber(call, Fold<Product>(call, Whole(1), 0)); }

Term Subtract(const Call& call) {
  const Number first = NumberAt(call, 0);
  if (call.size() == 1) return MakeNumber(call, Difference(Whole(0), first));
  return MakeNumber(call, Fold<Difference>(call, first, 1));
}

Term Divide(const Call& call) {
  Number result = NumberAt(call, 0);
  if (call.size() == 1) return MakeNumber(call, Quotient(call, Whole(1), result));
  for (std::size_t i = 1; i < call.size(); ++i) result = Quotient(call, result, NumberAt(call, i));
  return MakeNumber(call, result);
}

Term AddOne(const Call& call) { return MakeNumber(call, Sum(NumberAt(call, 0), Whole(1))); }
Term SubtractOne(const Call& call) {
  return MakeNumber(call, Difference(NumberAt(call, 0), Whole(1)));
}

Term Absolute(const Call& call) {
  const Number number = NumberAt(call, 0);
  return MakeNumber(call, number.real < 0.0 ? Difference(Whole(0), number) : number);
}

/// @param wanted  The sign of Compare(candidate, best) that makes a candidate the best.
template <int wanted>
Term Extreme(const Call& call) {
  std::size_t best = 0;
  Number best_number = NumberAt(call, 0);
  for (std::size_t i = 1; i < call.size(); ++i) {
    const Number number = NumberAt(call, i);
    if (Compare(number, best_number) != wanted) continue;
    best = i;
    best_number = number;
  }
  return call[best];
}

// Rounding: first the whole quotient towards minus infinity with its remainder, whose sign is the
// divisor's, then a step up where the function wants one.
enum class Rounding { kDown, kUp, kToZero, kToEven };

bool StepsUp(Rounding rounding, std::int64_t quotient, std::int64_t remainder,
             std::int64_t divisor) {
  if (remainder == 0) return false;
  if (rounding == Rounding::kUp) return true;
  if (rounding == Rounding::kToZero) return quotient < 0;
  if (rounding == Rounding::kDown) return false;
  const std::int64_t missing = divisor - remainder;
  if (remainder == missing) return quotient % 2 != 0;
  return divisor > 0 ? remainder > missing : remainder < missing;
}

Number RoundWhole(Rounding rounding, std::int64_t a, std::int64_t b) {
  std::int64_t quotient = a / b;
  std::int64_t remainder = a % b;
  if (remainder != 0 && (remainder < 0) != (b < 0)) {
    --quotient;
    remainder += b;
  }
  return Whole(StepsUp(rounding, quotient, remainder, b) ? quotient + 1 : quotient);
}

Number RoundReal(Rounding rounding, double value) {
  double whole = std::floor(value);
  if (rounding == Rounding::kUp) whole = std::ceil(value);
  if (rounding == Rounding::kToZero) whole = std::trunc(value);
  if (rounding == Rounding::kToEven) whole = std::nearbyint(value);
  constexpr double kTwoTo63 = 9223372036854775808.0;
  if (std::fabs(whole) >= kTwoTo63) return Real(whole);
  return Whole(static_cast<std::int64_t>(whole));
}

template <Rounding rounding>
Term Round(const Call& call) {
  const Number a = NumberAt(call, 0);
  const Number b = call.size() > 1 ? NumberAt(call, 1) : Whole(1);
  if (b.real == 0.0) RefuseZero(call);
  if (a.is_integer && b.is_integer && QuotientFits(a.integer, b.integer)) {
    return MakeNumber(call, RoundWhole(rounding, a.integer, b.integer));
  }
  return MakeNumber(call, RoundReal(rounding, a.real / b.real));
}

/// @param follows_divisor  The result takes the divisor's sign (mod), else the dividend's (rem).
template <bool follows_divisor>
Term Remainder(const Call& call) {
  const Number a = NumberAt(call, 0);
  const Number b = NumberAt(call, 1);
  if (b.real == 0.0) RefuseZero(call);
  if (a.is_integer && b.is_integer) {
    std::int64_t rest = b.integer == -1 ? 0 : a.integer % b.integer;
    if (follows_divisor && rest != 0 && (rest < 0) != (b.integer < 0)) rest += b.integer;
    return call.terms->Integer(rest);
  }
  double rest = std::fmod(a.real, b.real);
  if (follows_divisor && rest != 0.0 && (rest < 0.0) != (b.real < 0.0)) rest += b.real;
  return MakeNumber(call, Real(rest));
}

Term SquareRoot(const Call& call) {
  const double value = NumberAt(call, 0).real;
  if (value < 0.0) RefuseArgument(call, 0, "a number of at least 0");
  return MakeNumber(call, Real(std::sqrt(value)));
}

Number WholePower(Number base, std::int64_t exponent) {
  Number power = Whole(1);
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 != 0) power = Product(power, base);
    if (exponent > 1) base = Product(base, base);
  }
  return power;
}

Term Power(const Call& call) {
  const Number base = NumberAt(call, 0);
  const Number exponent = NumberAt(call, 1);
  if (base.real == 0.0 && exponent.real < 0.0) RefuseZero(call);
  if (base.is_integer && exponent.is_integer && exponent.integer >= 0) {
    return MakeNumber(call, WholePower(base, exponent.integer));
  }
  if (base.is_integer && exponent.is_integer && std::fabs(base.real) == 1.0) {
    return call.terms->Integer(exponent.integer % 2 != 0 ? base.integer : 1);
  }
  if (base.real < 0.0 && !exponent.is_integer) {
    RefuseArgument(call, 0, "a number of at least 0 where the exponent is no integer");
  }
  return MakeNumber(call, Real(std::pow(base.real, exponent.real)));
}

/// All arguments are numbers, and each is in the relation with the next. Looks at all, so that
/// (< 2 1 b) is refused as well.
template <bool (*holds)(int)>
bool Chain(const Call& call) {
  bool all = true;
  Number last = NumberAt(call, 0);
  for (std::size_t i = 1; i < call.size(); ++i) {
    const Number number = NumberAt(call, i);
    all = holds(Compare(last, number)) && all;
    last = number;
  }
  return all;
}

bool IsLess(int sign) { return sign < 0; }
bool IsLessOrEqual(int sign) { return sign <= 0; }
bool IsMore(int sign) { return sign > 0; }
bool IsMoreOrEqual(int sign) { return sign >= 0; }
bool IsEqual(int sign) { return sign == 0; }

bool AllDifferent(const Call& call) {
  std::unordered_set<std::uint32_t> seen;
  bool all = true;
  for (std::size_t i = 0; i < call.size(); ++i) {
    NumberAt(call, i);
    all = seen.insert(KeyUnder(Sameness::kEqualp, call.terms, call[i])->bits()).second && all;
  }
  return all;
}

bool IsZero(const Call& call) { return NumberAt(call, 0).real == 0.0; }
bool IsPositive(const Call& call) { return NumberAt(call, 0).real > 0.0; }
bool IsNegative(const Call& call) { return NumberAt(call, 0).real < 0.0; }
bool IsEven(const Call& call) { return IntegerAt(call, 0) % 2 == 0; }
bool IsOdd(const Call& call) { return IntegerAt(call, 0) % 2 != 0; }

void AddArithmetic(Functions* functions) {
  const auto add = [&](const char* name, int least, int most, Term (*function)(const Call&)) {
    functions->Add(name, least, most, StandardFunction{name, function});
  };
  add("+", 0, kAnyNumber, Add);
  add("-", 1, kAnyNumber, Subtract);
  add("*", 0, kAnyNumber, Multiply);
  add("/", 1, kAnyNumber, Divide);
  add("1+", 1, 1, AddOne);
  add("1-", 1, 1, SubtractOne);
  add("abs", 1, 1, Absolute);
  add("min", 1, kAnyNumber, Extreme<-1>);
  add("max", 1, kAnyNumber, Extreme<1>);
  add("floor", 1, 2, Round<Rounding::kDown>);
  add("ceiling", 1, 2, Round<Rounding::kUp>);
  add("truncate", 1, 2, Round<Rounding::kToZero>);
  add("round", 1, 2, Round<Rounding::kToEven>);
  add("mod", 2, 2, Remainder<true>);
  add("rem", 2, 2, Remainder<false>);
  add("sqrt", 1, 1, SquareRoot);
  add("expt", 2, 2, Power);
}

void AddComparison(Functions* functions) {
  const auto add = [&](const char* name, int most, bool (*predicate)(const Call&)) {
    functions->Add(name, 1, most, StandardPredicate{name, predicate});
  };
  add("<", kAnyNumber, Chain<IsLess>);
  add("<=", kAnyNumber, Chain<IsLessOrEqual>);
  add(">", kAnyNumber, Chain<IsMore>);
  add(">=", kAnyNumber, Chain<IsMoreOrEqual>);
  add("=", kAnyNumber, Chain<IsEqual>);
  add("/=", kAnyNumber, AllDifferent);
  add("zerop", 1, IsZero);
  add("plusp", 1, IsPositive);
  add("minusp", 1, IsNegative);
  add("evenp", 1, IsEven);
  add("oddp", 1, IsOdd);
}

}  // namespace

void AddNumberFunctions(Functions* functions) {
  AddArithmetic(functions);
  AddComparison(functions);
}

}  // namespace hires::planning
