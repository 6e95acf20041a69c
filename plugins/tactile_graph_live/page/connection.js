// The WebSocket to the server: messages in, commands out, and again after it was lost.

import { byId, mark, own, show, write } from "./dom.js";

const FIRST_WAIT_S = 0.25;
const LONGEST_WAIT_S = 5;
const SILENCE_S = 6;
const REFUSALS = 3; // tries after which it is asked why
const RUNS = { starting: "getting ready", waiting: "waiting for frames", ended: "the source ended", paused: "paused" };

export class Connection {
  /** `take` is called with every message; `changed` with whether there is a connection. */
  constructor(take, changed) {
    this.take = take;
    this.changed = changed;
    this.waits = 0;
    this.why = "";
    this.socket = null;
    byId("retry").addEventListener("click", () => this.open());
    addEventListener("online", () => this.open());
    addEventListener("pagehide", () => this.close());
    addEventListener("pageshow", (event) => event.persisted && this.open());
    setInterval(() => this.watch(), 1000);
    this.open();
  }

  open() {
    clearTimeout(this.timer);
    clearInterval(this.counting);
    this.close();
    const address = new URL("live", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    const socket = new WebSocket(address);
    this.socket = socket;
    this.heard = performance.now();
    this.tell("connecting", "connecting");
    socket.addEventListener("message", (event) => this.receive(socket, event.data));
    socket.addEventListener("close", () => socket === this.socket && this.lost());
  }

  close() {
    const socket = this.socket;
    this.socket = null;
    socket?.close();
  }

  receive(socket, text) {
    if (socket !== this.socket) return;
    this.heard = performance.now();
    let message;
    try {
      message = JSON.parse(text);
    } catch {
      return; // what is no message changes nothing
    }
    if (this.waits || !this.up) {
      this.waits = 0;
      this.why = "";
      this.up = true;
      this.tell("connected", "connected");
      show(byId("lost"), false);
      this.changed(true);
    }
    this.take(message);
  }

  /** A server that hangs closes nothing: no word for a while is a loss too. */
  watch() {
    const silent = (performance.now() - this.heard) / 1000 > SILENCE_S;
    const socket = this.socket;
    if (!socket || !silent || document.hidden) return;
    this.lost(); // at once: a server that hangs does not answer a close either
    socket.close();
  }

  lost() {
    this.socket = null;
    this.up = false;
    const wait = Math.min(LONGEST_WAIT_S, FIRST_WAIT_S * 2 ** this.waits) * (0.8 + 0.4 * Math.random());
    this.waits += 1;
    this.changed(false);
    this.tell("lost", "connection lost");
    show(byId("lost"), true);
    const due = performance.now() + wait * 1000;
    const count = () => {
      const left = Math.max(0, (due - performance.now()) / 1000);
      const rounds = `${this.waits} ${this.waits === 1 ? "try" : "tries"}`;
      write(byId("lost-text"), `${this.why}What you see is the last picture. Trying again in ${left.toFixed(0)} s (${rounds} so far).`);
    };
    count();
    this.counting = setInterval(count, 1000);
    this.timer = setTimeout(() => this.open(), wait * 1000);
    if (this.waits >= REFUSALS) this.ask().then(count);
  }

  /** Find out whether the server is gone or refuses this page: of a WebSocket no page is told. */
  async ask() {
    let why = "";
    try {
      const answer = await fetch("icon.svg", { cache: "no-store", signal: AbortSignal.timeout(SILENCE_S * 1000) });
      if (answer.status === 403) why = `The server refuses this page. ${(await answer.text()).trim()} One that was started anew has another token. `;
    } catch {
      // it is gone
    }
    this.why = this.up ? "" : why;
  }

  tell(state, text) {
    mark(byId("link"), "data-state", state);
    write(byId("link-text"), text);
  }

  /** Show how the bench does while there is a connection. */
  runs(state) {
    if (this.up) this.tell(state, own(RUNS, state) ?? "connected");
  }

  /** Send a command; without a connection it is dropped, and false returned. */
  send(type, fields = {}) {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify({ type, ...fields }));
    return true;
  }
}
