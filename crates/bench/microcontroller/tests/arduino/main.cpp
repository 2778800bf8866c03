// The sketch as a program: `setup` once, `loop` until the other process ends.
#include "Arduino.h"
#include SKETCH
int main() {
  setup();
  for (;;) loop();
}
