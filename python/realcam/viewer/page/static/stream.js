// WebSocket to the window's bench, shared by all components of the page. See stream.py for its protocol.

const FIRST_WAIT_MS = 250; // before the first attempt to reconnect
const STATE_KEY = `state of the window: ${document.title}`; // in the session's storage; the title contains the shot's name
const MAX_WAIT_MS = 4000; // between attempts to connect

class Stream {
  constructor(path) {
    this.path = path;
    this.listeners = new Map();
    this.latest = new Map(); // last message of each type, for components that are mounted later
    this.wait = FIRST_WAIT_MS;
    this.framesShown = 0;
    this.shown = {}; // headers of the frames shown, by slot
    this.isNew = true; // not connected yet
    this.on("state", ({ state }) => sessionStorage.setItem(STATE_KEY, JSON.stringify(state)));
    this.connect();
  }

  /// Restores the state of the page before a reload, by its user or after a restart of the server.
  restore() {
    const state = sessionStorage.getItem(STATE_KEY);
    if (state) this.send({ type: "restore", state: JSON.parse(state) });
  }

  /// Discards the stored state and reloads the page, which then shows the shot as in its file.
  startAgain() {
    this.on("state", () => sessionStorage.removeItem(STATE_KEY));
    sessionStorage.removeItem(STATE_KEY);
    location.reload();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    this.socket = new WebSocket(`${scheme}//${location.host}${this.path}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.wait = FIRST_WAIT_MS;
      this.notify("connection", { isOpen: true });
      if (this.isNew) this.restore();
      this.isNew = false;
    };
    this.socket.onmessage = (event) =>
      typeof event.data === "string" ? this.takeText(event.data) : this.takeFrame(event.data);
    this.socket.onclose = (event) => {
      this.notify("connection", { isOpen: false });
      if (event.code === 4404) {
        location.reload(); // the server was restarted and does not know this window
        return;
      }
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, MAX_WAIT_MS);
    };
  }

  takeText(text) {
    const message = JSON.parse(text);
    this.notify(message.type, message);
  }

  /// Decodes a frame, acknowledges it, and passes it to the listeners.
  async takeFrame(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    const jpeg = new Blob([new Uint8Array(buffer, 4 + length)], { type: "image/jpeg" });
    let bitmap;
    try {
      bitmap = await createImageBitmap(jpeg);
    } finally {
      if (this.socket.readyState === WebSocket.OPEN) this.socket.send(`ack ${header.slot} ${header.serial}`);
    }
    this.framesShown += 1;
    this.shown[header.slot] = header;
    this.notify("frame", { header, bitmap });
  }

  /// Passes a message to the listeners of its type.
  notify(type, message) {
    if (type !== "frame") this.latest.set(type, message);
    for (const listener of this.listeners.get(type) ?? []) listener(message);
  }

  /// Adds a listener. Returns a function that removes it.
  on(type, listener) {
    if (!this.listeners.has(type)) this.listeners.set(type, new Set());
    this.listeners.get(type).add(listener);
    if (this.latest.has(type)) listener(this.latest.get(type));
    return () => this.listeners.get(type).delete(listener);
  }

  /// Sends a message to the server, unless the connection is lost.
  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

const streams = new Map();

/// The stream with a path on the server, which all components share.
export function streamAt(path) {
  if (!streams.has(path)) streams.set(path, new Stream(path));
  return streams.get(path);
}
// For scripts that inspect a page from outside, such as tests.
window.realcamStreams = streams;

/// Calls f with the latest arguments, at most once per animation frame.
export function oncePerFrame(f) {
  let waiting = null;
  return (...args) => {
    if (waiting === null) requestAnimationFrame(() => {
      const last = waiting;
      waiting = null;
      f(...last);
    });
    waiting = args;
  };
}
