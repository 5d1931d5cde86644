#include "support/mutant.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>
#include <zlib.h>

namespace ehdjet::test {
namespace {

/// An HDF5 identifier. A call that fails is no fault here: not every change is possible.
class Id {
public:
  Id(hid_t id, herr_t (*close)(hid_t))
      : id_(id)
      , close_(close) {}
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  Id(Id&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID))
      , close_(other.close_) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  Id& operator=(Id&&) = delete;
  operator hid_t() const { return id_; } // NOLINT(google-explicit-constructor)

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

Id opened(hid_t file, const std::string& path) {
  return {H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose};
}
Id simple(std::vector<hsize_t> extent) {
  return {H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
          H5Sclose};
}

struct Target {
  std::string path;      // of the object
  std::string attribute; // or empty
};

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}
herr_t add_object(hid_t, const char* name, const H5O_info_t*, void* paths) {
  static_cast<std::vector<std::string>*>(paths)->emplace_back(name);
  return 0;
}

std::vector<Target> targets_of(hid_t file) {
  std::vector<std::string> paths;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add_object, &paths, H5O_INFO_BASIC);
  std::vector<Target> targets;
  for (const std::string& path : paths) {
    if (path != ".") targets.push_back({path, {}});
    std::vector<std::string> names;
    hsize_t place = 0;
    H5Aiterate2(opened(file, path), H5_INDEX_NAME, H5_ITER_INC, &place, add_attribute,
                &names);
    for (std::string& name : names)
      // Not for reading: they would only make the others rarer.
      if (name != "description") targets.push_back({path, std::move(name)});
  }
  return targets;
}

class Mutator {
public:
  Mutator(const std::filesystem::path& path, const Choose& choose)
      : choose_(choose)
      , path_(path)
      , file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose) {
    if (file_ < 0) throw std::runtime_error("cannot mutate " + path.string());
  }

  Mutation run() {
    const std::vector<Target> targets = targets_of(file_);
    // Half of the changes hit the checkpoint, which has the most to be damaged.
    std::vector<Target> checkpoint;
    std::ranges::copy_if(targets, std::back_inserter(checkpoint),
                         [](const Target& t) { return t.path.starts_with("checkpoint"); });
    int changes = 0;
    do {
      const bool there = !checkpoint.empty() && choose_(2) == 0;
      const auto& from = there ? checkpoint : targets;
      const Target& target = from[choose_(from.size())];
      made_.in_checkpoint |= target.path.starts_with("checkpoint");
      made_.text +=
          target.path + (target.attribute.empty() ? "" : "@") + target.attribute + ": ";
      if (!target.attribute.empty())
        change_attribute(target);
      else
        change_object(target.path);
      made_.text += "; ";
    } while (choose_(4) == 0 && ++changes < 20); // the choice may always be the first
    if (made_.in_checkpoint && choose_(2) == 0) {
      made_.with_checksums = true;
      for (const char* slot : {"checkpoint/a/", "checkpoint/b/"}) fit_checksums(slot);
    }
    return made_;
  }

private:
  template <class T>
  const T& any_of(const std::vector<T>& values) {
    return values[choose_(values.size())];
  }
  void say(const std::string& what) { made_.text += what; }

  double nasty_number(double was) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    switch (choose_(6)) {
    case 0:
      return any_of<double>({std::nan(""), infinity, -infinity, 0, -1, 1e300, -1e300,
                             1e-320, 0.5, 1, 2, 3, 1e9, 0x1p31, 0x1p53, 0x1p63, 0x1p64,
                             1e-15});
    case 1:
      return -was;
    case 2:
      return was * any_of<double>({0.5, 2, 10, 1e-6, 1e6, 1e12, 1 + 1e-12});
    case 3:
      return was + any_of<double>({1, -1, 0.5, 100, -100});
    case 4:
      return std::bit_cast<double>(choose_(0x7fffffffffffffff));
    default:
      return std::bit_cast<double>(std::bit_cast<std::uint64_t>(was) ^ 1ULL << choose_(64));
    }
  }
  std::string nasty_text(const std::string& was) {
    switch (choose_(8)) {
    case 0:
      return {};
    case 1:
      return was.substr(0, choose_(was.size() + 1));
    case 2:
      return was + was;
    case 3:
      return std::string(choose_(200000), 'x');
    case 4:
      return "\n`touch executed`\x1b[31m\"';$(touch executed)\n";
    case 5:
      return "a\nb\na\n";
    default: {
      std::string text = was.empty() ? "x" : was;
      text[choose_(text.size())] = static_cast<char>(1 + choose_(255));
      return text;
    }
    }
  }

  // The value of an attribute, or what takes its place.
  void change_attribute(const Target& target) {
    const Id object = opened(file_, target.path);
    const char* name = target.attribute.c_str();
    std::string text;
    double number = 0;
    {
      const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
      const Id type(H5Aget_type(attribute), H5Tclose),
          space(H5Aget_space(attribute), H5Sclose);
      if (H5Sget_simple_extent_npoints(space) != 1) {
        // No value of its own: something that was changed before, or references.
      } else if (H5Tis_variable_str(type) > 0) {
        char* value = nullptr;
        if (H5Aread(attribute, type, &value) >= 0 && value != nullptr) text = value;
        H5free_memory(value);
      } else {
        H5Aread(attribute, H5T_NATIVE_DOUBLE, &number);
      }
    }
    H5Adelete(object, name);
    switch (choose_(9)) {
    case 0:
      return say("deleted");
    case 1: {
      const std::vector<double> many(1000, number);
      return create_attribute(object, name, H5T_NATIVE_DOUBLE, simple({1000}), many.data());
    }
    case 2:
      return create_attribute(object, name, H5T_NATIVE_UINT64,
                              {H5Screate(H5S_NULL), H5Sclose}, nullptr);
    case 3: {
      const Id fixed(H5Tcopy(H5T_C_S1), H5Tclose);
      H5Tset_size(fixed, 1 + choose_(5000));
      const std::string characters(5000, 'y');
      return create_attribute(object, name, fixed, {H5Screate(H5S_SCALAR), H5Sclose},
                              characters.data());
    }
    case 4: {
      const std::vector<const char*> texts(1 + choose_(1000), text.c_str());
      return create_attribute(object, name, text_type(), simple({texts.size()}),
                              texts.data());
    }
    case 5:
    case 6: {
      const std::string nasty = nasty_text(text);
      const char* value = nasty.c_str();
      return create_attribute(object, name, text_type(), {H5Screate(H5S_SCALAR), H5Sclose},
                              &value);
    }
    default: {
      const double value = nasty_number(number);
      const hid_t type =
          any_of<hid_t>({H5T_NATIVE_DOUBLE, H5T_STD_U64LE, H5T_STD_I8LE, H5T_STD_I64BE});
      say(std::to_string(value) + ' ');
      return create_attribute(object, name, type, {H5Screate(H5S_SCALAR), H5Sclose}, &value,
                              H5T_NATIVE_DOUBLE);
    }
    }
  }
  void create_attribute(hid_t object, const char* name, hid_t type, const Id& space,
                        const void* values, hid_t memory = H5I_INVALID_HID) {
    const Id attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
    if (values != nullptr) H5Awrite(attribute, memory < 0 ? type : memory, values);
    say("another attribute of " + std::to_string(H5Sget_simple_extent_npoints(space)));
  }
  static Id text_type() {
    Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE), H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
  }

  void change_object(const std::string& path) {
    const std::uint64_t what = choose_(10);
    const bool is_list = [&] {
      const Id object = opened(file_, path);
      if (H5Iget_type(object) != H5I_DATASET) return false;
      const Id space(H5Dget_space(object), H5Sclose), type(H5Dget_type(object), H5Tclose);
      return H5Sget_simple_extent_ndims(space) == 1 && H5Tget_class(type) != H5T_STRING;
    }();
    if (is_list && what < 5) return change_values(path);
    if (is_list && what < 7) return change_length(path);
    if (!is_list && what < 6 && change_text(path)) return;
    if (what < 9) return put_another_kind(path);
    put_link(path);
  }

  // None if they are too many to be there.
  static std::vector<double> values_of(hid_t dataset) {
    constexpr hssize_t most = 1 << 20;
    const Id space(H5Dget_space(dataset), H5Sclose);
    const hssize_t rows = H5Sget_simple_extent_npoints(space);
    if (rows < 0 || rows > most) return {};
    std::vector<double> values(static_cast<std::size_t>(rows));
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    return values;
  }

  // Of some rows. In a checkpoint each list is hit as often as any other, and the part in use.
  void change_values(const std::string& path) {
    const Id dataset = opened(file_, path);
    std::vector<double> values = values_of(dataset);
    if (values.empty()) return say("empty");
    std::size_t row = choose_(values.size());
    if (path.ends_with("/numbers")) {
      const std::vector<double> offset =
          values_of(opened(file_, path.substr(0, path.rfind('/')) + "/offset"));
      const std::size_t list = choose_(std::max<std::size_t>(offset.size(), 2) - 1);
      if (list + 1 < offset.size() && offset[list] >= 0 && offset[list + 1] > offset[list]
          && offset[list + 1] <= static_cast<double>(values.size()))
        row = static_cast<std::size_t>(offset[list])
              + choose_(static_cast<std::uint64_t>(offset[list + 1] - offset[list]));
    }
    const double was = values[row];
    switch (choose_(8)) {
    case 0:
      std::swap(values[row], values[choose_(values.size())]);
      break;
    case 1:
      std::fill(values.begin() + static_cast<std::ptrdiff_t>(row), values.end(),
                nasty_number(was));
      break;
    default:
      values[row] = nasty_number(was);
    }
    say("row " + std::to_string(row) + " was " + std::to_string(was) + ", is "
        + std::to_string(values[row]));
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }

  void change_length(const std::string& path) {
    const Id dataset = opened(file_, path);
    const Id space(H5Dget_space(dataset), H5Sclose);
    const auto rows = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space));
    const hsize_t now =
        any_of<hsize_t>({0, rows / 2, rows - std::min<hsize_t>(rows, 1), rows + 1, 2 * rows,
                         1 << 20, 1ULL << 40, 1ULL << 61});
    H5Dset_extent(dataset, &now);
    say(std::to_string(now) + " rows");
  }

  bool change_text(const std::string& path) {
    const Id dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (dataset < 0) return false;
    const Id type(H5Dget_type(dataset), H5Tclose);
    if (H5Tis_variable_str(type) <= 0) return false;
    char* value = nullptr;
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value);
    const std::string was = value != nullptr ? value : "";
    H5free_memory(value);
    const std::string nasty = nasty_text(was);
    const char* text = nasty.c_str();
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text);
    say("another text");
    return true;
  }

  // A data set of another type or shape, with the old numbers where it has any.
  void put_another_kind(const std::string& path) {
    std::vector<double> values;
    {
      const Id dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
      if (dataset >= 0) {
        const Id type(H5Dget_type(dataset), H5Tclose);
        if (H5Tget_class(type) != H5T_STRING) values = values_of(dataset);
      }
    }
    H5Ldelete(file_, path.c_str(), H5P_DEFAULT);
    const hsize_t rows = values.size();
    values.resize(std::max<std::size_t>(values.size(), 1));
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const auto create = [&](hid_t type, const Id& space, const void* data, hid_t memory) {
      const Id dataset(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, properties,
                                  H5P_DEFAULT),
                       H5Dclose);
      if (data != nullptr) H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    };
    switch (choose_(14)) {
    case 0:
      return say("deleted");
    case 1:
      say("a number");
      return create(H5T_NATIVE_DOUBLE, {H5Screate(H5S_SCALAR), H5Sclose}, values.data(),
                    H5T_NATIVE_DOUBLE);
    case 2:
      say("two-dimensional");
      return create(H5T_NATIVE_DOUBLE, simple({rows, 1}), values.data(), H5T_NATIVE_DOUBLE);
    case 3:
      say("four bytes each");
      return create(H5T_NATIVE_FLOAT, simple({rows}), values.data(), H5T_NATIVE_DOUBLE);
    case 4:
      say("one byte each");
      return create(H5T_NATIVE_INT8, simple({rows}), values.data(), H5T_NATIVE_DOUBLE);
    case 5:
      say("without values");
      return create(H5T_NATIVE_DOUBLE,
                    simple({any_of<hsize_t>({rows, 1ULL << 40, 1ULL << 60})}), nullptr, 0);
    case 6: {
      say("texts");
      const std::vector<const char*> texts(rows, "text");
      return create(text_type(), simple({rows}), texts.data(), text_type());
    }
    case 7: {
      say("compound");
      const Id pair(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
      H5Tinsert(pair, "a", 0, H5T_NATIVE_DOUBLE),
          H5Tinsert(pair, "b", 8, H5T_NATIVE_DOUBLE);
      return create(pair, simple({rows}), nullptr, 0);
    }
    case 8: {
      say("arrays");
      const hsize_t many = 1000;
      const Id array(H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &many), H5Tclose);
      return create(array, simple({rows}), nullptr, 0);
    }
    case 9:
      say("numbers in another file");
      H5Pset_external(properties, path_.c_str(), 0, H5F_UNLIMITED);
      return create(H5T_NATIVE_DOUBLE, simple({std::max<hsize_t>(rows, 1)}), nullptr, 0);
    case 10: {
      say("virtual");
      const Id space = simple({std::max<hsize_t>(rows, 1)});
      H5Pset_virtual(properties, space, path_.c_str(), "observables/time", space);
      return create(H5T_NATIVE_DOUBLE, space, nullptr, 0);
    }
    case 11: {
      say("huge chunks");
      const hsize_t chunk = 1ULL << 28U, none = 0, unlimited = H5S_UNLIMITED;
      H5Pset_chunk(properties, 1, &chunk);
      create(H5T_NATIVE_DOUBLE, {H5Screate_simple(1, &none, &unlimited), H5Sclose}, nullptr,
             0);
      const Id dataset = opened(file_, path);
      H5Dset_extent(dataset, &rows);
      return;
    }
    case 12:
      say("bits");
      return create(H5T_STD_B64LE, simple({rows}), nullptr, 0);
    default:
      say("a group");
      const Id group(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                     H5Gclose);
    }
  }

  void put_link(const std::string& path) {
    const std::string kept = path + "_was";
    H5Lmove(file_, path.c_str(), file_, kept.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    switch (choose_(6)) {
    case 0:
      say("a link to itself");
      H5Lcreate_soft(path.c_str(), file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 1:
      say("a link to nothing");
      H5Lcreate_soft("/nothing", file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 2:
      say("a link to another file");
      H5Lcreate_external("other.h5", path.c_str(), file_, path.c_str(), H5P_DEFAULT,
                         H5P_DEFAULT);
      break;
    case 3:
      say("a link to the root");
      H5Lcreate_hard(file_, "/", file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 4:
      say("another name");
      break;
    default:
      say("a link to what it was");
      H5Lcreate_soft(("/" + kept).c_str(), file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
  }

  template <class T>
  void fit_checksum(hid_t dataset, hid_t type, std::size_t rows) {
    std::vector<T> values(rows);
    const hsize_t first = 0, count = rows;
    const Id space(H5Dget_space(dataset), H5Sclose),
        memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &count, nullptr);
    if (rows > 0 && H5Dread(dataset, type, memory, space, H5P_DEFAULT, values.data()) < 0)
      return;
    const std::uint64_t sum = ::crc32(0, reinterpret_cast<const Bytef*>(values.data()),
                                      static_cast<uInt>(rows * sizeof(T)));
    H5Adelete(dataset, "crc32");
    create_attribute(dataset, "crc32", H5T_NATIVE_UINT64, {H5Screate(H5S_SCALAR), H5Sclose},
                     &sum);
  }

  // Those of the lists as long as names and offsets say they are.
  void fit_checksums(const std::string& slot) {
    const Id names(H5Dopen2(file_, "checkpoint/names", H5P_DEFAULT), H5Dclose);
    const Id type(H5Dget_type(names), H5Tclose);
    char* value = nullptr;
    if (names < 0 || H5Tis_variable_str(type) <= 0
        || H5Dread(names, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) < 0)
      return;
    const std::string text = value != nullptr ? value : "";
    H5free_memory(value);
    const std::uint64_t sum = ::crc32(0, reinterpret_cast<const Bytef*>(text.data()),
                                      static_cast<uInt>(text.size()));
    H5Adelete(names, "crc32");
    create_attribute(names, "crc32", H5T_NATIVE_UINT64, {H5Screate(H5S_SCALAR), H5Sclose},
                     &sum);
    const auto lists = static_cast<std::size_t>(std::ranges::count(text, '\n'));
    const Id offset = opened(file_, slot + "offset"),
             numbers = opened(file_, slot + "numbers");
    if (H5Iget_type(offset) != H5I_DATASET || H5Iget_type(numbers) != H5I_DATASET) return;
    const std::vector<double> ends = values_of(offset);
    if (ends.size() <= lists) return;
    fit_checksum<std::uint64_t>(offset, H5T_NATIVE_UINT64, lists + 1);
    if (ends[lists] >= 0 && ends[lists] <= 1 << 20)
      fit_checksum<double>(numbers, H5T_NATIVE_DOUBLE,
                           static_cast<std::size_t>(ends[lists]));
  }

  const Choose& choose_;
  std::filesystem::path path_;
  Id file_;
  Mutation made_;
};

} // namespace

Mutation mutate(const std::filesystem::path& file, const Choose& choose) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return Mutator(file, choose).run();
}

Mutation mutate(const std::filesystem::path& file, std::uint64_t number) {
  std::mt19937_64 bits(number);
  return mutate(file, [&](std::uint64_t n) { return bits() % n; });
}

} // namespace ehdjet::test
