"""The air between two XBee S1: one half-duplex 250 kb/s channel.

Modelled: air time, acknowledgement, up to three MAC retries times (1 + RR), silent loss of whole packets in good and
bad periods, addresses, broadcast without retries, order, queueing of two senders.
Not modelled: back-off slots (RN), clear-channel failures (EC stays 0), third parties, corrupted payload (16-bit FCS).
Time: two events for each packet: its arrival, and the release of the channel.
Sources: XB sections on transparent mode, addressing, MAC retries; IEEE 802.15.4 rate.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from typing import Final, Protocol

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, Clock
from emulator.devices.xbee_parameters import BROADCAST

#: 250 kb/s: 32 us a byte; preamble, header and check sequence weigh about 21 bytes.
BYTE_CYCLES: Final = 32 * CYCLES_PER_US
OVERHEAD_BYTES: Final = 21
ACK_CYCLES: Final = 1 * CYCLES_PER_MS
MAC_TRIES: Final = 4

#: CHOICE: firmware and radio latency of a packet: fixed for an ideal pair, uniform between the bounds otherwise.
LATENCY_IDEAL_CYCLES: Final = 2 * CYCLES_PER_MS
LATENCY_CYCLES: Final = (1 * CYCLES_PER_MS, 5 * CYCLES_PER_MS)


class Station(Protocol):
    """A module as the radio channel sees it."""

    @property
    def radio_settings(self) -> dict[str, int]:
        """Working parameters."""

    def radio_free(self) -> None:
        """The channel is free: a waiting module may try again."""

    def radio_received(self, payload: bytes) -> None:
        """A packet for this module."""

    def radio_failed(self) -> None:
        """The last packet was not acknowledged."""


class RadioChannel:
    """The channel.

    `packet_loss` is the chance that a unicast packet is lost after all retries, `burst_loss` the same in a bad spell
    (Wi-Fi near); spells begin and end between packets with the chances `burst_begin` and `burst_end`.  Tries are
    independent, so each fails with the fourth root of the loss (CHOICE), which also gives retries their share.
    """

    def __init__(
        self,
        clock: Clock,
        *,
        rng: random.Random,
        ideal: bool = True,
        packet_loss: float = 0.001,
        burst_loss: float = 0.03,
        burst_begin: float = 0.002,
        burst_end: float = 0.1,
    ) -> None:
        chances = {
            "packet_loss": packet_loss,
            "burst_loss": burst_loss,
            "burst_begin": burst_begin,
            "burst_end": burst_end,
        }
        for name, p in chances.items():
            if not 0.0 <= p <= 1.0:
                raise ValueError(f"XBee air: {name}={p}; expected a probability, 0 to 1")
        self.clock = clock
        self.ideal = ideal
        self.busy = False
        #: The numbers of packets sent, of packets lost, and of tries beyond the first.
        self.packets = 0
        self.lost = 0
        self.retries = 0
        #: The faults that act on packets now: each returns `(lost, delay_cycles)` for one.
        self.interferences: list[Callable[[], tuple[bool, int]]] = []
        self._rng = rng
        self._loss = (packet_loss, burst_loss)
        self._burst_begin = burst_begin
        self._burst_end = burst_end
        self._in_burst = False
        self._stations: list[Station] = []
        self._waiting: deque[Station] = deque()
        self._sender: Station | None = None
        self._flying = 0

    def flying(self, station: Station) -> int:
        """The number of bytes that `station` has on the air."""
        return self._flying if self._sender is station else 0

    def join(self, station: Station) -> None:
        """Add a module to the channel."""
        self._stations.append(station)

    def wait(self, station: Station) -> None:
        """Note that `station` wants to send when the channel is free."""
        if station not in self._waiting:
            self._waiting.append(station)

    def send(self, station: Station, payload: bytes) -> None:
        """Send one packet now.  Raises ValueError while the channel is busy."""
        if self.busy:
            raise ValueError("XBee air: a packet was sent while the channel is busy; wait() first")
        self.busy = True
        self.packets += 1
        self._sender = station
        self._flying = len(payload)
        own = station.radio_settings
        receivers = [s for s in self._stations if s is not station and _addressed(own, s.radio_settings)]
        broadcast = own["DH"] == 0 and own["DL"] == BROADCAST
        acknowledged = not broadcast and own["MM"] != 1
        most = MAC_TRIES * (1 + own["RR"]) if acknowledged else 1
        tries = self._tries(most) if receivers else 0
        lost, delay = False, 0
        for interference in self.interferences:
            own_lost, own_delay = interference()
            lost, delay = lost or own_lost, delay + own_delay
        if lost:
            tries = 0
        used = tries or most
        self.retries += used - 1
        latency = delay + (LATENCY_IDEAL_CYCLES if self.ideal else self._rng.randint(*LATENCY_CYCLES))
        one_try = (len(payload) + OVERHEAD_BYTES) * BYTE_CYCLES
        arrival = self.clock.now + latency + used * one_try + (used - 1) * ACK_CYCLES
        if tries:
            self.clock.schedule(arrival, lambda: self._arrive(receivers, payload))
        else:
            self.lost += 1
        end = arrival + (ACK_CYCLES if acknowledged else 0)
        self.clock.schedule(end, lambda: self._end(station, failed=acknowledged and not tries))

    def _tries(self, most: int) -> int:
        """How many tries it took, 0 for a packet that is lost."""
        if self.ideal:
            return 1
        rng = self._rng
        self._in_burst = rng.random() >= self._burst_end if self._in_burst else rng.random() < self._burst_begin
        fails = self._loss[self._in_burst] ** (1.0 / MAC_TRIES)
        for n in range(1, most + 1):
            if rng.random() >= fails:
                return n
        return 0

    def _arrive(self, receivers: list[Station], payload: bytes) -> None:
        self._flying = 0
        for station in receivers:
            station.radio_received(payload)

    def _end(self, station: Station, *, failed: bool) -> None:
        self.busy = False
        self._flying = 0
        if failed:
            station.radio_failed()
        # A station that has waited goes first; the sender may have more to send.
        self.wait(station)
        for _ in range(len(self._waiting)):
            if self.busy:
                break
            self._waiting.popleft().radio_free()


def _addressed(sender: dict[str, int], receiver: dict[str, int]) -> bool:
    """Whether a packet reaches: same channel and network, and broadcast, or 16-bit or 64-bit destination."""
    if sender["CH"] != receiver["CH"] or sender["ID"] != receiver["ID"]:
        return False
    if sender["DH"] == 0 and sender["DL"] <= 0xFFFF:
        return sender["DL"] == BROADCAST or (sender["DL"] == receiver["MY"] and receiver["MY"] != 0xFFFF)
    return (sender["DH"], sender["DL"]) == (receiver["SH"], receiver["SL"])
