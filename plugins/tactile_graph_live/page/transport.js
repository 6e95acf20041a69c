// Pause, step, live, tare, record, and the bar of the last minute.

import { byId, mark, write } from "./dom.js";
import { counted } from "./numbers.js";

const SCRUB_MS = 30;
const HELD_MS = 400;
const BACK_S = 0.1;

export class Transport {
  /** `send` takes a command and its fields. */
  constructor(send) {
    this.send = send;
    this.paused = false;
    this.backS = 0;
    this.tared = false;
    this.recording = { on: false };
    this.bar = byId("time");
    this.movedAt = -Infinity;
    byId("pause").addEventListener("click", () => this.pause());
    byId("step").addEventListener("click", () => this.step());
    byId("live").addEventListener("click", () => this.live());
    byId("tare").addEventListener("click", () => this.tare());
    byId("record-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.record();
    });
    this.bar.addEventListener("input", () => this.scrub(-Number(this.bar.value)));
  }

  pause() {
    this.send(this.paused ? "resume" : "pause");
  }

  step() {
    this.send("step");
  }

  live() {
    clearTimeout(this.timer); // a scrub not sent yet would undo it
    this.timer = undefined;
    this.movedAt = -Infinity;
    this.bar.value = "0";
    this.send("live");
  }

  tare() {
    this.send(this.tared ? "untare" : "tare");
  }

  record() {
    this.send("record", { on: !this.recording.on, label: byId("label").value.trim() });
  }

  back() {
    this.scrub(Math.min(-Number(this.bar.min), this.backS + BACK_S));
    this.bar.value = String(-this.asked);
  }

  scrub(backS) {
    this.movedAt = performance.now();
    this.asked = Math.max(0, backS);
    this.say(this.asked);
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.send("scrub", { back_s: this.asked });
    }, SCRUB_MS);
  }

  say(backS) {
    const text = backS > 0.005 ? `${backS.toFixed(backS < 10 ? 2 : 1)} s ago` : "now";
    write(byId("time-text"), text);
    mark(this.bar, "aria-valuetext", text);
  }

  /** Take what a frame says of when it was. */
  paint(frame) {
    this.backS = frame.back_s;
    if (performance.now() - this.movedAt > HELD_MS) {
      const value = String(-Math.round(frame.back_s * 50) / 50);
      if (this.bar.value !== value) this.bar.value = value;
      this.say(frame.back_s);
    }
    this.buttons();
  }

  /** Take what a pulse says of how it runs. */
  take(pulse) {
    this.paused = pulse.paused;
    this.tared = pulse.tared;
    this.recording = pulse.recording;
    const kept = Math.max(0.1, Math.min(60, pulse.kept_s)).toFixed(1);
    if (this.bar.min !== `-${kept}`) this.bar.min = `-${kept}`;
    mark(byId("tare"), "aria-pressed", pulse.tared);
    const { on, file, frames, lost } = pulse.recording;
    mark(byId("record"), "aria-pressed", on);
    write(byId("record").lastElementChild, on ? "Stop" : "Record");
    const so_far = `${counted(frames)} frames ${on ? "into" : "in"} ${file}${lost ? `, ${counted(lost)} not kept up with` : ""}`;
    write(byId("recording"), file ? so_far : "");
    this.buttons();
  }

  buttons() {
    const live = !this.paused && this.backS <= 0.005;
    const pause = byId("pause");
    write(pause.lastElementChild, this.paused ? "Run" : "Pause");
    write(pause.firstElementChild, this.paused ? "▶" : "❚❚");
    mark(byId("live"), "aria-pressed", live);
  }
}
