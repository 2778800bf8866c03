// The sketch as a program: `setup` once, `loop` until nobody listens.
#include "Arduino.h"
#include SKETCH
int main() {
  setup();
  for (;;) loop();
}
