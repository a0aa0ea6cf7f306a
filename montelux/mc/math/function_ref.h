// FunctionRef: a callable that the caller keeps, without its type; the std::function_ref of C++26.
#pragma once

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

namespace montelux {

template <typename Signature>
class FunctionRef;

// Only for parameters: the callable has to outlive it.
template <typename Result, typename... Arguments>
class FunctionRef<Result(Arguments...)> {
  public:
    template <typename F>
    requires(!std::same_as<std::remove_cvref_t<F>, FunctionRef> &&
             std::is_invocable_r_v<Result, const F&, Arguments...>)
        FunctionRef(const F& f) // NOLINT(google-explicit-constructor): a callable is passed as it stands
        : callable_(std::addressof(f)), call_([](const void* callable, Arguments... arguments) -> Result {
              return (*static_cast<const F*>(callable))(std::forward<Arguments>(arguments)...);
          }) {}

    Result operator()(Arguments... arguments) const {
        return call_(callable_, std::forward<Arguments>(arguments)...);
    }

  private:
    const void* callable_;
    Result (*call_)(const void*, Arguments...);
};

} // namespace montelux
