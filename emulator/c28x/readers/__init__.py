"""Readers: what turns source into the typed tree, one package a language."""
