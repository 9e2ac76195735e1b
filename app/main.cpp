#include "app/command_line.h"
#include "app/watch.h"

int main(int argc, char** argv) {
    sightlines::hold_stop_signals();
    return static_cast<int>(sightlines::run_command_line(argc, argv));
}
