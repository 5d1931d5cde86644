#pragma once

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/error.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ehdjet {

/// Named lists of numbers with which a run can be continued with the same bits. Counts and flags
/// are stored as numbers, exact up to 2^53; an optional value is a list of one number or none.
using Checkpoint = std::map<std::string, std::vector<double>>;

/// Moves the state of objects into a checkpoint or out of one. An object names its members once,
/// for both directions:
///
///     void Thing::archive(const Archive& a) { a("count", count_), a("sum", sum_); }
///
/// errors : InputError if a checkpoint that is read has no list of that name and length
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
    if (!take(found->second, value))
      throw InputError("the checkpoint is damaged: " + path + " has another length");
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

  template <class T>
  static bool take(const List& list, T& value) {
    if (list.size() != 1) return false;
    value = static_cast<T>(list[0]);
    return true;
  }
  static bool take(const List& list, List& value) {
    value = list;
    return true;
  }
  static bool take(const List& list, CompensatedSum& value) {
    if (list.size() != 2) return false;
    value = CompensatedSum(list[0], list[1]);
    return true;
  }
  template <class T>
  static bool take(const List& list, std::optional<T>& value) {
    value.reset();
    return list.empty() || take(list, value.emplace());
  }

  Checkpoint* to_;
  const Checkpoint* from_;
  std::string prefix_;
};

} // namespace ehdjet
