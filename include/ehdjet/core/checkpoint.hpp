#pragma once

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace ehdjet {

/// Whether all values are finite numbers.
[[nodiscard]] inline bool all_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}
[[nodiscard]] inline bool none_negative(const std::vector<double>& values) {
  return std::ranges::none_of(values, [](double v) { return v < 0; });
}

/// Named lists of numbers with which a run can be continued with the same bits. Counts and flags
/// are stored as numbers, exact up to 2^53; an optional value is a list of one number or none.
using Checkpoint = std::map<std::string, std::vector<double>>;

/// Moves the state of objects into a checkpoint or out of one. An object names its members once,
/// for both directions:
///
///     void Thing::archive(const Archive& a) { a("count", count_), a("sum", sum_); }
///
/// A checkpoint that is read may have been made by anybody: a count is a whole number, a flag 0 or 1, and nothing
/// is NaN. What else must hold of a member, its `archive` says with `require`.
/// errors : InputError that names the list if a checkpoint that is read breaks such a rule or has no list
///          of that name and length
class Archive {
public:
  static Archive into(Checkpoint& to) { return {&to, nullptr, ""}; }
  static Archive from(const Checkpoint& from) { return {nullptr, &from, ""}; }

  [[nodiscard]] bool is_reading() const { return from_ != nullptr; }
  /// The same for a member that has members of its own.
  [[nodiscard]] Archive part(std::string_view name) const {
    return {to_, from_, prefix_ + std::string(name) + '.'};
  }

  /// Names of the lists of this part in the checkpoint that is read.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (auto i = from_->lower_bound(prefix_);
         i != from_->end() && i->first.starts_with(prefix_); ++i)
      found.push_back(i->first.substr(prefix_.size()));
    return found;
  }

  /// `value`: a number, count, flag or sum, an optional one of these, or a list of numbers.
  template <class T>
  void operator()(std::string_view name, T& value) const {
    const std::string path = prefix_ + std::string(name);
    if (!is_reading()) {
      put((*to_)[path], value);
      return;
    }
    const auto found = from_->find(path);
    if (found == from_->end()) throw InputError("the checkpoint has no " + path);
    if (const char* flaw = take(found->second, value)) refuse(path, flaw);
  }
  /// What has been read must keep a rule: `rule` says what is wrong otherwise ("is negative").
  void require(std::string_view name, bool kept, std::string_view rule) const {
    if (is_reading() && !kept) refuse(prefix_ + std::string(name), rule);
  }

private:
  using List = std::vector<double>;
  Archive(Checkpoint* to, const Checkpoint* from, std::string prefix)
      : to_(to)
      , from_(from)
      , prefix_(std::move(prefix)) {}

  template <class T>
  static void put(List& list, const T& value) {
    list = {static_cast<double>(value)};
  }
  static void put(List& list, const List& value) { list = value; }
  static void put(List& list, const CompensatedSum& value) {
    list = {value.leading(), value.carry()};
  }
  template <class T>
  static void put(List& list, const std::optional<T>& value) {
    list.clear();
    if (value) put(list, *value);
  }

  [[noreturn]] static void refuse(const std::string& path, std::string_view flaw) {
    throw InputError("the checkpoint is damaged: " + path + ' ' + std::string(flaw));
  }

  /// Null, or what is wrong with the list.
  template <class T>
  static const char* take(const List& list, T& value) {
    if (list.size() != 1) return "has another length";
    const double number = list[0];
    if (std::isnan(number)) return "is not a number";
    if constexpr (std::is_same_v<T, bool>) {
      if (number != 0 && number != 1) return "is neither 0 nor 1";
    } else if constexpr (std::is_integral_v<T>) {
      constexpr double most =
          std::min(0x1p53, 0x1p-1 * static_cast<double>(std::numeric_limits<T>::max()));
      if (number != std::floor(number) || !(std::abs(number) <= most))
        return "is not a whole number";
      if (std::is_unsigned_v<T> && number < 0) return "is negative";
    }
    value = static_cast<T>(number);
    return nullptr;
  }
  static const char* take(const List& list, List& value) {
    if (std::ranges::any_of(list, [](double v) { return std::isnan(v); }))
      return "has a value that is not a number";
    value = list;
    return nullptr;
  }
  static const char* take(const List& list, CompensatedSum& value) {
    if (list.size() != 2) return "has another length";
    if (!std::isfinite(list[0]) || !std::isfinite(list[1])) return "is not finite";
    value = CompensatedSum(list[0], list[1]);
    return nullptr;
  }
  template <class T>
  static const char* take(const List& list, std::optional<T>& value) {
    value.reset();
    return list.empty() ? nullptr : take(list, value.emplace());
  }

  Checkpoint* to_;
  const Checkpoint* from_;
  std::string prefix_;
};

} // namespace ehdjet
