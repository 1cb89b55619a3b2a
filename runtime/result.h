// Result<T>: a value, or an Error that says what is wrong, where, and what to do. The way that
// input from outside (files, devices, command lines) fails; a bug is PENUMBRA_ASSERT. No exception
// crosses a module's border.
//   Result<Mesh> mesh = readObj(path);
//   if (!mesh) return mesh.error();
//   use(*mesh);
#pragma once

#include "runtime/assert.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace penumbra {

struct Error {
    std::string message; // "file.glb: accessor 3: …; re-export the mesh": place, problem, remedy
};

// The same error with a place in front: fail(error, "file.glb") -> "file.glb: …".
[[nodiscard]] inline Error fail(const Error& error, const std::string& place)
{
    return {place + ": " + error.message};
}

template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : m_state(std::move(value)) {}
    Result(Error error) : m_state(std::move(error)) {}

    [[nodiscard]] bool ok() const { return m_state.index() == 0; }
    explicit operator bool() const { return ok(); }

    [[nodiscard]] T& operator*() & { return value(); }
    [[nodiscard]] const T& operator*() const& { return const_cast<Result*>(this)->value(); }
    [[nodiscard]] T&& operator*() && { return std::move(value()); }
    [[nodiscard]] T* operator->() { return &value(); }
    [[nodiscard]] const T* operator->() const { return &const_cast<Result*>(this)->value(); }

    [[nodiscard]] const Error& error() const
    {
        PENUMBRA_ASSERT(!ok(), "error() of a Result that holds a value");
        return *std::get_if<1>(&m_state);
    }

private:
    T& value()
    {
        PENUMBRA_ASSERT(ok(), "value of a failed Result: {}", std::get_if<1>(&m_state)->message);
        return *std::get_if<0>(&m_state);
    }

    std::variant<T, Error> m_state;
};

template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : m_error(std::move(error)) {}

    [[nodiscard]] bool ok() const { return !m_error.has_value(); }
    explicit operator bool() const { return ok(); }

    [[nodiscard]] const Error& error() const
    {
        PENUMBRA_ASSERT(!ok(), "error() of a Result that succeeded");
        return *m_error;
    }

private:
    std::optional<Error> m_error;
};

} // namespace penumbra
