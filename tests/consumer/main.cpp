#include <realcam/math/vec3.hpp>

int main() {
    return 0;
}
