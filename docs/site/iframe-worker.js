// Web workers for pages that are opened as files, where browsers refuse real ones: the script runs in a hidden frame.
// The theme's search expects the name IFrameWorker, and that the frame's importScripts returns a promise.
if (location.protocol === "file:") {
  const load = (page, url) =>
    new Promise((loaded, failed) => {
      const script = page.createElement("script");
      script.src = url;
      script.onload = loaded;
      script.onerror = () => failed(new Error(`${url} cannot be read`));
      page.head.append(script);
    });

  window.IFrameWorker = class extends EventTarget {
    constructor(url) {
      super();
      this.element = document.createElement("iframe");
      this.element.hidden = true;
      this.element.srcdoc = "<!doctype html><html><head></head><body></body></html>";
      const address = new URL(url, document.baseURI).href;
      this.ready = new Promise((opened) => (this.element.onload = opened)).then(() => {
        const frame = this.element.contentWindow;
        frame.postMessage = (data) => this.deliver(this, data);
        frame.importScripts = (...urls) =>
          urls.reduce((before, next) => before.then(() => load(frame.document, next)), Promise.resolve());
        return load(frame.document, address);
      });
      this.ready.catch((error) => this.dispatchEvent(new ErrorEvent("error", { error, message: error.message })));
      document.body.append(this.element);
    }

    deliver(target, data) {
      const event = new MessageEvent("message", { data });
      const handler = target.onmessage;
      target.dispatchEvent(event);
      // A window calls its own onmessage, an EventTarget does not.
      if (target === this && handler) handler.call(target, event);
    }

    postMessage(data) {
      this.ready.then(() => this.deliver(this.element.contentWindow, data)).catch(() => {});
    }

    terminate() {
      this.element.remove();
    }
  };
  window.Worker = window.IFrameWorker;
}
