"""Messages of the contract as plain Python, in the words of affskel-client."""
from __future__ import annotations

import re
from collections.abc import MutableSequence
from typing import Any, Dict

from ._errors import UsageError


def _word(value: Any) -> str:
    """Of an enumeration's value: JOB_STATE_DONE is "done"; "" for "unspecified"."""
    if value.number == 0:
        return ""
    # JobState's values begin with JOB_STATE_.
    prefix = re.sub(r"(?<!^)(?=[A-Z])", "_", value.type.name).upper() + "_"
    return str(value.name)[len(prefix):].lower().replace("_", "-")


def word(kind: Any, number: int) -> str:
    """The word for a number of the enumeration `kind`; "" for one that is not known."""
    value = kind.DESCRIPTOR.values_by_number.get(number)
    return _word(value) if value is not None else ""


def value_of_word(kind: Any, text: str, what: str) -> Any:
    """The number of the value with this word.  Raises UsageError that tells the words."""
    words = {_word(value): value.number for value in kind.DESCRIPTOR.values if value.number}
    if text not in words:
        raise UsageError(f"there is no {what} '{text}'; there are {', '.join(words)}")
    return words[text]


def plain(message: Any) -> Dict[str, Any]:
    """All fields by name: messages as dictionaries, enumerations as words, what is absent as None."""
    return {one.name: _plain_field(message, one) for one in message.DESCRIPTOR.fields}


def _plain_field(message: Any, one: Any) -> Any:
    if one.has_presence and not message.HasField(one.name):
        return None
    value = getattr(message, one.name)
    if isinstance(value, MutableSequence):
        return [_plain_value(one, element) for element in value]
    return _plain_value(one, value)


def _plain_value(one: Any, value: Any) -> Any:
    if one.message_type is not None:
        return plain(value)
    if one.enum_type is not None:
        known = one.enum_type.values_by_number.get(value)
        return _word(known) if known is not None else ""
    return value
