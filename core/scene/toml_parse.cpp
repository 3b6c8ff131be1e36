// The one place that knows the TOML library. It is compiled in here rather than linked, so that its
// assertions can be turned into errors: text such as "[$" reaches one of them.
#include <algorithm>
#include <exception>

#include "core/scene/toml_tree.hpp"

namespace {
struct TomlAssertion : std::exception {};
[[noreturn]] void fail_assertion() {
  throw TomlAssertion();
}
}  // namespace

#undef NDEBUG  // with it the library drops its assertions and runs on
#undef TOML_SHARED_LIB
#undef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : fail_assertion())
#define TOML_MAX_NESTED_VALUES 128
#include <toml++/toml.h>

namespace unfurl {

namespace {

SourceLocation location(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

TomlTree convert(const toml::node& node, const std::string& file) {
  TomlTree tree;
  tree.where = location(node.source(), file);
  if (const auto* boolean = node.as_boolean()) {
    tree.kind = TomlTree::Kind::boolean;
    tree.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    tree.kind = TomlTree::Kind::integer;
    tree.integer = static_cast<long>(integer->get());
  } else if (const auto* real = node.as_floating_point()) {
    tree.kind = TomlTree::Kind::real;
    tree.real = real->get();
  } else if (const auto* text = node.as_string()) {
    tree.kind = TomlTree::Kind::text;
    tree.text = text->get();
  } else if (const auto* array = node.as_array()) {
    tree.kind = TomlTree::Kind::array;
    tree.items.reserve(array->size());
    for (const auto& item : *array) tree.items.push_back(convert(item, file));
  } else if (const auto* table = node.as_table()) {
    tree.kind = TomlTree::Kind::table;
    for (const auto& [key, value] : *table) {
      tree.entries.emplace_back(std::string(key.str()), convert(value, file));
      tree.entries.back().second.key_where = location(key.source(), file);
    }
    std::stable_sort(tree.entries.begin(), tree.entries.end(), [](const auto& a, const auto& b) {
      const SourceLocation &x = a.second.key_where, &y = b.second.key_where;
      return x.line != y.line ? x.line < y.line : x.column < y.column;
    });
  } else {
    tree.kind = TomlTree::Kind::time;
  }
  return tree;
}

// "Error while parsing key-value pair: ..." without the opening that every message shares.
std::string description(const toml::parse_error& error) {
  const std::string_view text = error.description(), opening = "Error while parsing ";
  return std::string(text.starts_with(opening) ? text.substr(opening.size()) : text);
}

bool reaches_assertion(std::string_view text) {
  try {
    const toml::table ignored = toml::parse(text);
  } catch (const TomlAssertion&) {
    return true;
  } catch (const toml::parse_error&) {
    return false;
  }
  return false;
}

// The byte whose presence makes the library fail an assertion: a longer beginning of the text fails as well,
// a shorter one does not, so bisection finds it.
std::size_t assertion_offset(std::string_view text) {
  std::size_t passes = 0, fails = text.size();
  while (passes + 1 < fails) {
    const std::size_t middle = passes + (fails - passes) / 2;
    (reaches_assertion(text.substr(0, middle)) ? fails : passes) = middle;
  }
  return passes;
}

}  // namespace

TomlTree parse_toml(std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (const TextObstacle obstacle = find_toml_obstacle(text); !obstacle.message.empty())
    throw SceneError({{locate(text, obstacle.offset, file), "", obstacle.message}});
  try {
    return convert(toml::parse(text), file);
  } catch (const toml::parse_error& error) {
    throw SceneError({{location(error.source(), file), "", "not TOML: " + description(error)}});
  } catch (const TomlAssertion&) {
    const std::size_t offset = assertion_offset(text);
    throw SceneError({{locate(text, offset, file), "", "not TOML: unexpected character here"}});
  }
}

}  // namespace unfurl
