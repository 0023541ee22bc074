"""Readers of firmware source, one package a language."""
