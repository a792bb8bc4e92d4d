// A client of npm @foxglove/ws-protocol: takes so many touches, asks for a zero, and prints what it got as JSON.
import { createRequire } from "node:module";

const load = createRequire(process.env.FINGERTIP_NODE_MODULES + "/");
const { FoxgloveClient } = load("@foxglove/ws-protocol");
const WebSocket = load("ws");

const [address, count] = [process.argv[2], Number(process.argv[3])];
const client = new FoxgloveClient({ ws: new WebSocket(address, ["foxglove.sdk.v1"]) });
const said = { numbers: [], loads: [], channels: {}, zero: null };
let touches = null;
let tare = null;

client.on("error", (error) => {
    console.error(error);
    process.exit(1);
});
client.on("advertise", (channels) => {
    for (const channel of channels) {
        said.channels[channel.topic] = [channel.encoding, channel.schemaName, channel.schemaEncoding];
        if (channel.topic === "/fingertip/touch") {
            touches = client.subscribe(channel.id);
        }
    }
});
client.on("advertiseServices", (services) => {
    tare = services.find((service) => service.name === "/fingertip/tare");
});
client.on("message", ({ subscriptionId, data }) => {
    if (subscriptionId !== touches || said.numbers.length === count) {
        return;
    }
    // Little-endian CDR: a stamp, the name of the frame, then number and time, each at a multiple of its size.
    const view = new DataView(data.buffer, data.byteOffset + 4, data.byteLength - 4);
    let at = 12 + view.getUint32(8, true);
    at = Math.ceil(at / 8) * 8;
    said.numbers.push(Number(view.getBigUint64(at, true)));
    at += 16;
    at += 4 + view.getUint32(at, true);
    at = Math.ceil(at / 8) * 8;
    said.loads.push([0, 1, 2, 3, 4, 5].map((axis) => view.getFloat64(at + 8 * axis, true)));
    if (said.numbers.length === count) {
        client.sendServiceCallRequest({
            serviceId: tare.id,
            callId: 7,
            encoding: "json",
            data: new DataView(new TextEncoder().encode("{}").buffer),
        });
    }
});
client.on("serviceCallResponse", ({ callId, data }) => {
    said.zero = JSON.parse(new TextDecoder().decode(data));
    said.call = callId;
    process.stdout.write(JSON.stringify(said), () => process.exit(0));
});
