// Eight MS5837-30BA behind a TCA9548A, as CSV for `twintac stream --serial PORT --line firmware/lines/csv-8.toml`. Never run
// on a board. 3.3 V: SDA, SCL, GND; pin 4 to the switch's RESET. Second order, 64 bits (TE, MS5837-30BA, REV C2, 12/2019).
#include <Wire.h>
const uint8_t N = 8, SWITCH = 0x70, CHIP = 0x76, RESET_PIN = 4, SAMPLES = 0x06, WAIT_MS = 5; // 2048 samples: 4.54 ms at most
uint16_t prom[N][8]; uint32_t d1[N], d2[N], sequence; // the eighth word of a PROM stays 0
uint8_t code[N], trouble; // 0 good, 1 missing, 2 stuck, 6 out of range, 9 uncalibrated; trouble 3: no switch
unsigned at, resets; char line[320];
bool send(uint8_t to, uint8_t byte) { return Wire.beginTransmission(to), Wire.write(byte), Wire.endTransmission() == 0; }
uint32_t ask(uint8_t i, uint8_t command, uint8_t n) { // 0 if nobody answers
  if (!send(SWITCH, 1 << i) || !send(CHIP, command) || Wire.requestFrom(CHIP, n) != n) return code[i] = 1, 0;
  uint32_t value = 0;
  for (; n; n--) value = value << 8 | (uint8_t)Wire.read();
  return value;
}
uint16_t check(uint16_t sum, uint16_t bits, uint16_t polynomial) { // of a cyclic redundancy check, eight bits on
  for (sum ^= bits, bits = 8; bits--;) sum = sum & 0x8000 ? sum << 1 ^ polynomial : sum << 1;
  return sum;
}
void start(uint8_t i) { // resets a chip, and sees that what it was calibrated to is whole
  send(SWITCH, 1 << i), send(CHIP, 0x1E), delay(10), code[i] = 0;
  for (uint8_t w = 0; w < 7; w++) prom[i][w] = ask(i, 0xA0 + 2 * w, 2);
  uint16_t sum = 0, first = prom[i][0] & 0x0FFF;
  for (uint8_t b = 0; b < 16; b++) sum = check(sum, (b < 2 ? first : prom[i][b / 2]) >> (b % 2 ? 0 : 8) & 0xFF, 0x3000);
  if (!code[i] && (sum >> 12 != prom[i][0] >> 12 || !prom[i][1])) code[i] = 9;
}
void convert(uint8_t command, uint32_t *d) { // one trigger for all chips, then each is read; 0: too early
  send(SWITCH, 0xFF), send(CHIP, command + SAMPLES), delay(WAIT_MS);
  for (uint8_t i = 0; i < N; i++) if (!code[i] && !(d[i] = ask(i, 0x00, 3)) && !code[i]) code[i] = 2;
}
void print(uint8_t i, bool is_pressure) { // hundredths of a Pa or of a degree
  const uint16_t *c = prom[i];
  int64_t dt = (int64_t)d2[i] - ((int64_t)c[5] << 8), t = 2000 + (dt * c[6] >> 23), cold = t - 2000, frost = t + 1500;
  int64_t off = ((int64_t)c[2] << 16) + (c[4] * dt >> 7) - (t < 2000 ? 3 * cold * cold >> 1 : cold * cold >> 4);
  int64_t sens = ((int64_t)c[1] << 15) + (c[3] * dt >> 8) - (t < 2000 ? 5 * cold * cold >> 3 : 0);
  if (t < -1500) off -= 7 * frost * frost, sens -= 4 * frost * frost;
  int64_t p = (((d1[i] * sens >> 21) - off) * 125 + 512) >> 10; // of 10 / 8192 Pa
  long v = is_pressure ? p : t - (t < 2000 ? 3 * dt * dt >> 33 : 2 * dt * dt >> 37), size = labs(v);
  if (!code[i] && (p < 0 || p > 300000000)) code[i] = 6;
  if (code[i]) at += sprintf(line + at, ",nan");
  else at += sprintf(line + at, ",%s%ld.%02d", v < 0 ? "-" : "", size / 100, (int)(size % 100));
}
void setup() {
  Serial.begin(1000000), Wire.begin(), Wire.setClock(400000);
#ifdef WIRE_HAS_TIMEOUT
  Wire.setWireTimeout(5000, true); // else an AVR waits for ever when the bus is held
#endif
}
void loop() {
  trouble = send(SWITCH, 0) ? 0 : 3;
  if (trouble) resets++, pinMode(RESET_PIN, OUTPUT), digitalWrite(RESET_PIN, LOW), delay(1), pinMode(RESET_PIN, INPUT);
  for (uint8_t i = 0; i < N; i++) if (sequence % 16 == 0 && (!sequence || code[i])) start(i); else if (code[i] == 6) code[i] = 0;
  if (sequence % 16 == 0) convert(0x50, d2);
  at = sprintf(line, "%lu,%lu", (unsigned long)sequence++, (unsigned long)micros());
  convert(0x40, d1);
  for (uint8_t i = 0; i < 2 * N; i++) print(i % N, i < N);
  for (uint8_t i = 0; i < N; i++) at += sprintf(line + at, ",%d", code[i]);
  uint16_t sum = (at += sprintf(line + at, ",%d,%u", trouble, resets), 0xFFFF);
  for (unsigned k = 0; k < at;) sum = check(sum, (uint16_t)line[k++] << 8, 0x1021);
  sprintf(line + at, "*%04X", sum), Serial.println(line);
}
