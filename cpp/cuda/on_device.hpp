#pragma once
#include <memory>
#include <utility>

#include "current_device.hpp"

namespace realcam {

struct DestroyOnDevice {
    int ordinal = 0;

    template <class T>
    void operator()(T* object) const noexcept {
        const CurrentDevice current(ordinal, std::nothrow);
        delete object;
    }
};

/// Owner of an object that holds memory, streams or events of one GPU: the object is created and destroyed with that
/// GPU current, on any thread.
template <class T>
using OnDevice = std::unique_ptr<T, DestroyOnDevice>;

template <class T, class... Arguments>
OnDevice<T> make_on_device(int ordinal, Arguments&&... arguments) {
    const CurrentDevice current(ordinal);
    return OnDevice<T>(new T(std::forward<Arguments>(arguments)...), {ordinal});
}

}  // namespace realcam
