// The part of Arduino's Wire that the sketch needs, over the same pipe.
#pragma once
#include "Arduino.h"

#define WIRE_HAS_TIMEOUT

class TwoWire {
public:
  void begin() {}
  void setClock(uint32_t hz) { asked("clock %ld\n", (long)hz); }
  void setWireTimeout(uint32_t, bool) {}
  void beginTransmission(uint8_t address) { to = address, n = 0; }
  size_t write(uint8_t byte) { return n < sizeof bytes ? bytes[n++] = byte, 1 : 0; }
  uint8_t endTransmission() {
    printf("write %d", to);
    for (size_t i = 0; i < n; i++) printf(" %d", bytes[i]);
    return (uint8_t)asked("%.0ld\n", 0);
  }
  uint8_t requestFrom(uint8_t address, uint8_t count) {
    printf("read %d %d\n", address, count);
    fflush(stdout);
    char answer[256];
    if (!fgets(answer, sizeof answer, stdin)) exit(0);
    n = at = 0;
    for (char *word = strtok(answer, " \n"); word && n < sizeof bytes; word = strtok(nullptr, " \n")) bytes[n++] = (uint8_t)atoi(word);
    return (uint8_t)n;
  }
  int read() { return at < n ? bytes[at++] : -1; }

private:
  uint8_t to = 0, bytes[32] = {};
  size_t n = 0, at = 0;
};
inline TwoWire Wire;
